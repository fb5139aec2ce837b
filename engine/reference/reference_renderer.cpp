#include "engine/reference/reference_renderer.h"

#include <algorithm>
#include <cmath>

#include "engine/error.h"
#include "engine/reference/6_composite_sheet.h"
#include "engine/reference/7_resolve.h"
#include "engine/reference/parallel.h"
#include "engine/volume/filters.h"
#include "footprints/kernel.h"

namespace edgesplat::reference {

namespace {

void check_size(int width, int height) {
    if (width < 1 || height < 1 || width > 16384 || height > 16384) {
        fail("picture of {} x {} pixels, expected 1 to 16384 each", width, height);
    }
}

Payload payload_for(Output output) {
    switch (output) {
        case Output::Depth:
            return Payload::Depth;
        case Output::Distance:
            return Payload::Distance;
        case Output::Normal:
            return Payload::Normal;
        case Output::Color:
        case Output::Tau:
            break;
    }
    return Payload::Color;
}

Image resolve(std::span<const glm::dvec4> frame, int width, int height, const Scene& scene, Output output) {
    switch (output) {
        case Output::Color:
            return resolve_color(frame, width, height, scene.background);
        case Output::Tau:
            return resolve_sum(frame, width, height);
        case Output::Normal:
            return resolve_normal(frame, width, height);
        case Output::Depth:
        case Output::Distance:
            break;
    }
    return resolve_mean(frame, width, height);
}

}  // namespace

PreparedVolume::PreparedVolume(const Volume& volume, const Scene& scene, const Settings& settings, bool quantised)
    : volume_(&volume),
      scene_((validate(scene), scene)),
      settings_((validate(settings), settings)),
      scaled_(scale_scene(scene, volume)),
      values_(scaled_field(volume)),
      footprints_(settings) {
    if (settings.edges == EdgeEstimator::Cubic) {
        coefficients_ = bspline_coefficients(values_, volume.geometry.dims);
    }
    edges_ = smooth_edges(field(), scaled_, settings_, estimate_edges(field(), scaled_, settings_, quantised));
    if (quantised) std::transform(edges_.begin(), edges_.end(), edges_.begin(), quantise);
}

Image PreparedVolume::render(const Camera& camera, int width, int height, Output output) const {
    check_size(width, height);
    const Field f = field();
    const VolumeGeometry& geometry = volume_->geometry;
    const View view(camera, geometry, width, height);
    const std::vector<SplatRecord> records =
        collect_splats(f, scaled_, edges_, scene_, geometry, settings_, camera.eye, output == Output::Tau);
    const std::vector<Selected> selected = select_footprints(records, f, view, settings_, footprints_);
    const SortedSheets sorted = sort_sheets(selected);
    const SplatDrawer drawer(records, selected, f, scene_, view, settings_, footprints_);

    const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    std::vector<glm::dvec4> frame(pixels, glm::dvec4(0));
    if (output == Output::Tau) {
        drawer.draw(sorted.order, Payload::Color, {}, frame);
        return resolve(frame, width, height, scene_, output);
    }
    std::vector<char> closed(pixels, 0);
    std::vector<glm::dvec4> sheet(pixels);
    for (std::size_t s = 0; s < sorted.sheets(); ++s) {
        if (s % kSheetsPerGroup == 0) {
            std::transform(frame.begin(), frame.end(), closed.begin(),
                           [&](const glm::dvec4& v) { return v.w >= settings_.saturation ? 1 : 0; });
        }
        if (sorted.sheet(s).empty()) continue;
        std::fill(sheet.begin(), sheet.end(), glm::dvec4(0));
        drawer.draw(sorted.sheet(s), payload_for(output), closed, sheet);
        composite_sheet(frame, sheet, closed);
    }
    return resolve(frame, width, height, scene_, output);
}

Image render(const Volume& volume, const Scene& scene, const Camera& camera, const Settings& settings, int width,
             int height, Output output) {
    return PreparedVolume(volume, scene, settings).render(camera, width, height, output);
}

Image direct_evaluation(const PreparedVolume& prepared, const Camera& camera, int width, int height, Output output,
                        double step) {
    check_size(width, height);
    if (output != Output::Color && output != Output::Tau) fail("direct evaluation gives colour or tau only");
    if (!(step > 0)) fail("direct evaluation step: {} is not above 0", step);
    const Field field = prepared.field();
    const VolumeGeometry& geometry = prepared.volume().geometry;
    const View view(camera, geometry, width, height);
    const Footprints footprints(prepared.settings());
    std::vector<double> extinction(field.values.size(), 0.0);
    std::vector<glm::dvec3> color(field.values.size(), glm::dvec3(0));
    for (std::size_t i = 0; i < extinction.size(); ++i) {
        SplatRecord record{static_cast<std::uint32_t>(i), 0, prepared.edges()[i]};
        record.material =
            static_cast<std::uint32_t>(prepared.scaled_scene().material(static_cast<double>(field.values[i])));
        extinction[i] = prepared.scene().materials[record.material].extinction;
        color[i] = payload_of(record, field, prepared.scene(), view, prepared.settings(), Payload::Color);
    }

    std::vector<glm::dvec4> frame(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), glm::dvec4(0));
    const glm::dvec3 center = glm::dvec3(field.dims - 1) / 2.0;
    // A warp draws on kernels up to its band farther than they reach on their own.
    const double reach = kKernelRadius + prepared.settings().edge_half_width;
    const double bound = glm::length(center) + reach;
    const auto march_pixel = [&](int x, int y) {
        const glm::dvec3 u = view.ray(x, y);
        const double mm = glm::length(geometry.index_to_world_axes * u);
        const double middle = glm::dot(center - view.eye_index, u);
        glm::dvec4 result(0);
        for (double t = std::max(middle - bound, 0.0) + step / 2; t < middle + bound; t += step) {
            const glm::dvec3 p = view.eye_index + t * u;
            const glm::ivec3 low = glm::max(glm::ivec3(glm::ceil(p - reach)), glm::ivec3(0));
            const glm::ivec3 high = glm::min(glm::ivec3(glm::floor(p + reach)), field.dims - 1);
            glm::dvec4 sum(0);
            for (int k = low.z; k <= high.z; ++k) {
                for (int j = low.y; j <= high.y; ++j) {
                    for (int i = low.x; i <= high.x; ++i) {
                        const glm::ivec3 voxel(i, j, k);
                        const std::size_t at = field.offset(voxel);
                        if (!(extinction[at] > 0)) continue;
                        const double h = footprints.at_point(prepared.edges()[at], p - glm::dvec3(voxel));
                        sum += extinction[at] * h * glm::dvec4(color[at], 1);
                    }
                }
            }
            if (!(sum.w > 0)) continue;
            const double tau = sum.w * mm * step;
            if (output == Output::Tau) {
                result.w += tau;
            } else {
                result += (1 - result.w) * -std::expm1(-tau) * glm::dvec4(glm::dvec3(sum) / sum.w, 1);
            }
        }
        return result;
    };
    parallel_for(height, [&](int begin, int end) {
        for (int y = begin; y < end; ++y) {
            for (int x = 0; x < width; ++x) {
                frame[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)] =
                    march_pixel(x, y);
            }
        }
    });
    return resolve(frame, width, height, prepared.scene(), output);
}

}  // namespace edgesplat::reference

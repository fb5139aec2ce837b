#include "engine/accuracy/downsample.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "engine/accuracy/metrics.h"
#include "engine/error.h"
#include "engine/reference/direct_evaluation.h"
#include "engine/reference/field.h"
#include "engine/volume/grid.h"
#include "engine/volume/packed_volume.h"

namespace edgesplat::accuracy {
namespace {

std::vector<std::pair<std::string, Settings>> variants_of(const Settings& edge) {
    Settings plain = edge;
    plain.edges = EdgeEstimator::Off;
    return {{"plain", plain}, {"paper", paper_settings(edge)}, {"edge", edge}};
}

/// The points in index space of a volume coarser by `factor`; the profile's unit stays a fine voxel.
std::vector<SurfacePoint> coarser(std::vector<SurfacePoint> points, int factor) {
    for (SurfacePoint& p : points) {
        p.position = (p.position - (factor - 1) / 2.0) / static_cast<double>(factor);
        p.axis /= factor;
    }
    return points;
}

}  // namespace

Volume box_downsampled(const Volume& volume, int factor) {
    require_samples(volume, "down-sampling");
    const glm::ivec3 dims = volume.geometry.dims / std::max(factor, 1);
    if (factor < 2 || glm::any(glm::lessThan(dims, glm::ivec3(2))))
        fail("down-sampling by {}: expected a factor of at least 2 that leaves 2 voxels along each axis", factor);
    Volume result = volume;
    result.geometry.dims = dims;
    result.geometry.index_to_world_axes = volume.geometry.index_to_world_axes * static_cast<double>(factor);
    result.geometry.origin = volume.geometry.to_world(glm::dvec3((factor - 1) / 2.0));
    result.values.clear();
    result.no_data.reset();
    for (int z = 0; z < dims.z; ++z)
        for (int y = 0; y < dims.y; ++y)
            for (int x = 0; x < dims.x; ++x) {
                double sum = 0;
                int count = 0;
                for (int c = 0; c < factor; ++c)
                    for (int b = 0; b < factor; ++b)
                        for (int a = 0; a < factor; ++a)
                            if (const glm::ivec3 i(factor * x + a, factor * y + b, factor * z + c);
                                volume.has_data(i)) {
                                sum += static_cast<double>(volume.at(i.x, i.y, i.z));
                                ++count;
                            }
                const bool enough = 2 * count >= factor * factor * factor;
                result.values.push_back(enough ? static_cast<float>(sum / count)
                                               : std::numeric_limits<float>::quiet_NaN());
            }
    finish_volume(result);
    return result;
}

SurfacePoints surface_points(const Volume& volume, double iso, int count, double room) {
    SurfacePoints result;
    const reference::Field field{volume.geometry.dims, volume.values, {}};
    const glm::dvec3 top(volume.geometry.dims - 1);
    const auto above = [&](const glm::dvec3& p) { return reference::sample(field, p) - iso; };
    std::mt19937 random(21);
    const auto uniform = [&] { return random() / 4294967296.0; };
    for (int trial = 0; trial < 4000 * count && static_cast<int>(result.points.size()) < count; ++trial) {
        const double a = uniform(), b = uniform(), c = uniform();
        const glm::dvec3 start = glm::dvec3(a, b, c) * top;
        const auto axis = static_cast<int>(random() % 3);
        glm::dvec3 step(0);
        step[axis] = 1;
        if (start[axis] + 1 > top[axis] || (above(start) < 0) == (above(start + step) < 0)) continue;
        double low = 0, high = 1;
        for (int i = 0; i < 50; ++i) {
            const double middle = (low + high) / 2;
            ((above(start + middle * step) < 0) == (above(start) < 0) ? low : high) = middle;
        }
        SurfacePoint point{start + high * step, {}};
        const glm::dvec3 g = reference::point_gradient(field, point.position);
        if (!(glm::length(g) > 0)) continue;
        point.axis = -g / glm::length(g);
        // Oblique surfaces cross more edges of cells per area; this evens it out.
        if (uniform() * (std::abs(point.axis.x) + std::abs(point.axis.y) + std::abs(point.axis.z)) > 1) continue;
        const glm::dvec3 margin(room + 2);
        if (glm::any(glm::lessThan(point.position, margin)) ||
            glm::any(glm::greaterThan(point.position, top - margin))) {
            ++result.near_border;
            continue;
        }
        bool clear = true;
        for (double s = 0.5; s <= room && clear; s += 0.5)
            clear = above(point.position - s * point.axis) >= 0 && above(point.position + s * point.axis) < 0;
        if (clear)
            result.points.push_back(point);
        else
            ++result.disturbed;
    }
    return result;
}

SurfaceDifference surface_difference(const RenderResult& coarse, const RenderResult& fine, double distance_mm) {
    SurfaceDifference result;
    const Image& a = coarse.color;
    const Image& b = fine.color;
    for (int y = 0; y < a.height; ++y) {
        for (int x = 0; x < a.width; ++x) {
            const bool here = a.at(x, y, 3) >= 0.5F, there = b.at(x, y, 3) >= 0.5F;
            result.invented += here && !there ? 1 : 0;
            result.lost += there && !here ? 1 : 0;
            if (!coarse.depth || !fine.depth) continue;
            const double apart =
                std::abs(static_cast<double>(coarse.depth->at(x, y, 0)) - static_cast<double>(fine.depth->at(x, y, 0)));
            result.displaced += here && there && apart > distance_mm ? 1 : 0;
        }
    }
    const double pixels = static_cast<double>(a.width) * a.height;
    for (double* share : {&result.invented, &result.lost, &result.displaced})
        *share /= pixels;
    if (!coarse.depth || !fine.depth) result.displaced = std::numeric_limits<double>::quiet_NaN();
    return result;
}

namespace {

class Experiment {
  public:
    Experiment(Renderer& renderer, const ResolutionRequest& request, const ProgressFunction& progress)
        : renderer_(renderer), request_(request), progress_(progress) {
        report_.request = request;
        report_.device = renderer.device();
        report_.cameras = report_cameras(*request.volume, request.scene, request.size.x, request.size.y);
        pieces_ = 2 + 5 * request.factors.size();
    }

    ResolutionReport run() {
        renderer_.set_volume(request_.volume);
        full_ = render_all(request_.settings);
        full_rays_ = cast_all();
        for (const RenderResult& r : full_)
            report_.full.push_back(r.color);
        const reference::PreparedVolume model(*request_.volume, request_.scene, request_.settings);
        for (const int factor : request_.factors)
            report_.factors.push_back(measure(factor, model));
        renderer_.set_volume(request_.volume);
        return report_;
    }

  private:
    void next(const std::string& what) {
        const Progress state{static_cast<double>(done_) / static_cast<double>(pieces_), 0, done_, pieces_, what};
        ++done_;
        if (progress_ && !progress_(state)) throw Interrupted("stopped; nothing was written");
    }

    template <typename Picture>
    std::vector<RenderResult> of_cameras(const Picture& picture) {
        next("pictures");
        std::vector<RenderResult> list;
        for (const ReportCamera& camera : report_.cameras)
            list.push_back(picture(camera.camera));
        return list;
    }

    std::vector<RenderResult> render_all(const Settings& settings) {
        return of_cameras([&](const Camera& camera) {
            return renderer_.render(request_.scene, camera, settings, request_.size.x, request_.size.y,
                                    {.depth = true});
        });
    }

    std::vector<RenderResult> cast_all() {
        return of_cameras([&](const Camera& camera) {
            return renderer_.raycast(request_.scene, camera, request_.settings, {}, request_.size.x, request_.size.y);
        });
    }

    /// Compares pictures of a copy with those of the full volume; the result goes into `variant`.
    static void compare(const std::vector<RenderResult>& pictures, const std::vector<RenderResult>& full,
                        double voxel_mm, VariantResult& variant) {
        std::vector<ImageError> errors;
        const double n = static_cast<double>(pictures.size());
        for (std::size_t c = 0; c < pictures.size(); ++c) {
            errors.push_back(image_error(pictures[c].color, full[c].color));
            const SurfaceDifference d = surface_difference(pictures[c], full[c], voxel_mm);
            variant.surface.invented += d.invented / n;
            variant.surface.lost += d.lost / n;
            variant.surface.displaced += d.displaced / n;
            variant.pictures.push_back(pictures[c].color);
        }
        variant.rmse = pooled(errors).rms;
    }

    FactorResult measure(int factor, const reference::PreparedVolume& full_model) {
        next(fmt::format("edges, factor {}", factor));
        FactorResult result;
        result.factor = factor;
        const auto coarse = std::make_shared<const Volume>(box_downsampled(*request_.volume, factor));
        result.dims = coarse->geometry.dims;
        const SurfacePoints surface =
            surface_points(*request_.volume, request_.scene.iso_values.front(), request_.surface_points, 1.5 * factor);
        result.points = static_cast<int>(surface.points.size());
        result.disturbed = surface.disturbed;
        result.near_border = surface.near_border;
        const ProfileRange range{2.5 * factor, 0.01 * factor};
        result.full = edge_figures(full_model, surface.points, range);

        renderer_.set_volume(coarse);
        const double voxel_mm = shortest_spacing(coarse->geometry);
        for (const auto& [name, settings] : variants_of(request_.settings)) {
            VariantResult variant{.name = name, .settings = settings};
            compare(render_all(settings), full_, voxel_mm, variant);
            const reference::PreparedVolume model(*coarse, request_.scene, settings);
            variant.edges = edge_figures(model, coarser(surface.points, factor), range);
            result.variants.push_back(std::move(variant));
        }
        VariantResult rays{.name = "rays", .settings = request_.settings};
        compare(cast_all(), full_rays_, voxel_mm, rays);
        rays.edges =
            ray_edge_figures(*coarse, request_.scene.iso_values.front(), coarser(surface.points, factor), range);
        result.variants.push_back(std::move(rays));
        const VariantResult plain = result.variants.front();
        for (VariantResult& v : result.variants) {
            v.recovered_rise =
                (plain.edges.rise_mean - v.edges.rise_mean) / (plain.edges.rise_mean - result.full.rise_mean);
            v.recovered_rmse = (plain.rmse - v.rmse) / plain.rmse;
        }
        return result;
    }

    Renderer& renderer_;
    const ResolutionRequest& request_;
    const ProgressFunction& progress_;
    ResolutionReport report_;
    std::vector<RenderResult> full_, full_rays_;
    std::size_t pieces_ = 1, done_ = 0;
};

}  // namespace

ResolutionReport measure_resolution(Renderer& renderer, const ResolutionRequest& request,
                                    const ProgressFunction& progress) {
    return Experiment(renderer, request, progress).run();
}

}  // namespace edgesplat::accuracy

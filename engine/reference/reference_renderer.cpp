#include "engine/reference/reference_renderer.h"

#include <algorithm>
#include <deque>

#include "engine/error.h"
#include "engine/image/sample_mean.h"
#include "engine/reference/2b_occlude_ambient.h"
#include "engine/reference/2c_cast_shadows.h"
#include "engine/reference/6_composite_sheet.h"
#include "engine/reference/7_resolve.h"
#include "engine/reference/pixel_rows.h"
#include "engine/reference/surfaces.h"
#include "engine/scene/mixture.h"
#include "engine/scene/transfer_function.h"
#include "engine/volume/filters.h"
#include "engine/volume/parallel.h"

namespace edgesplat::reference {

namespace {

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
            return resolve_color(frame, width, height, scene.background, scene.effects.background_top);
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

bool is_before(const CarriedEdge& carried, std::size_t voxel) {
    return carried.voxel < voxel;
}

/// mm per voxel along the ray of a pixel.
double mm_along(const View& view, std::size_t pixel) {
    const int number = static_cast<int>(pixel);
    return glm::length(view.geometry.index_to_world_axes * view.ray(number % view.width, number / view.width));
}

}  // namespace

PreparedVolume::PreparedVolume(const Volume& volume, const Scene& whole_scene, const Settings& settings, bool quantised)
    : PreparedVolume(volume, scene_of_volume((validate(whole_scene), whole_scene), 0, volume.geometry), settings,
                     quantised, scene_of_volume(whole_scene, 0, volume.geometry)) {
    for (std::size_t i = 0; i < whole_scene.added.size(); ++i)
        added_.push_back(std::make_shared<const PreparedVolume>(
            *whole_scene.added[i].volume, scene_of_volume(whole_scene, i + 1, volume.geometry), settings, quantised));
    const Scene& scene = scene_;
    const auto mixture = mixture_of(settings_, scene_, volume);
    if (!mixture) return;
    const auto part = [&](const Scene& of) {
        return std::shared_ptr<const PreparedVolume>(new PreparedVolume(volume, of, settings, quantised, scene));
    };
    opaque_ = part(mixture->surfaces);
    translucent_ = part(scene_of_kernels(mixture->kernels));
}

PreparedVolume::PreparedVolume(const Volume& volume, const Scene& scene, const Settings& settings, bool quantised,
                               const Scene& whole)
    : volume_(&volume),
      scene_((validate(scene), scene)),
      settings_((validate(settings), canonical_settings(settings, scene))),
      lighting_(whole),
      scaled_(scale_scene(scene, volume)),
      shading_(scale_scene(whole, volume)),
      values_(scaled_field(volume)),
      footprints_(settings_, table_depth(scene_, volume.geometry)) {
    if (settings_.edges == EdgeEstimator::Cubic) {
        coefficients_ = bspline_coefficients(values_, volume.geometry.dims);
    }
    // Faces need the surfels on both sides of a surface, also those of materials that are not drawn.
    ScaledScene estimated = scaled_;
    if (draws_faces(settings_)) estimated.drawn.assign(estimated.drawn.size(), true);
    const std::vector<VoxelEdge> edges = estimate_edges(field(), estimated, settings_, quantised);
    if (!scaled_.transfer.empty()) classified_ = classified_values(field(), scaled_, edges);
    if (draws_surfaces(settings_, scene_, volume)) {
        const double range = static_cast<double>(volume.max_value) - static_cast<double>(volume.min_value);
        ScaledScene bodies = surface_scene_.emplace(scene_, volume).bodies;
        bodies.drawn.assign(bodies.drawn.size(), true);
        surfaces_ = surface_splats(field(), *surface_scene_, estimate_edges(field(), bodies, settings_, quantised),
                                   range > 0 ? volume.noise / range : 0, quantised);
    }
    edges_ = finish_edges(field(), scaled_, settings_, edges);
    if (draws_faces(settings_)) {
        carried_ = voxels_beside(field(), scaled_);
        finish_carried(field(), scaled_, settings_, edges, carried_);
    }
    for (CarriedEdge& carried : carried_) {
        if (quantised) carried.edge = quantise(carried.edge);
        if (!scaled_.transfer.empty()) carried.value = carried_value(field(), scaled_, edges, carried);
    }
    if (quantised) std::transform(edges_.begin(), edges_.end(), edges_.begin(), quantise);
}

std::span<const CarriedEdge> PreparedVolume::carried_by(std::size_t voxel) const {
    const auto first = std::lower_bound(carried_.begin(), carried_.end(), voxel, is_before);
    return {first, std::lower_bound(first, carried_.end(), voxel + 1, is_before)};
}

void PreparedVolume::replace_edge(std::size_t voxel, int material, const VoxelEdge& edge) {
    if (scaled_.material(field().at(field().voxel(voxel))) == material) edges_[voxel] = edge;
    auto carried = std::lower_bound(carried_.begin(), carried_.end(), voxel, is_before);
    for (; carried != carried_.end() && carried->voxel == voxel; ++carried)
        if (carried->material == material) carried->edge = edge;
}

const PreparedVolume* PreparedVolume::opaque_part() const {
    return opaque_ ? opaque_.get() : surface_scene_ ? this : nullptr;
}

const PreparedVolume* PreparedVolume::kernel_part() const {
    return translucent_ ? translucent_.get() : surface_scene_ || !has_matter(scene_) ? nullptr : this;
}

View PreparedVolume::view_of(const Camera& camera, const glm::ivec2& size, const glm::dvec2& offset,
                             Output output) const {
    View view(camera, volume_->geometry, size.x, size.y);
    view.offset = offset;
    if (scene_.effects.antialias) view.low_pass = 1.0 / (output == Output::Color ? scene_.effects.samples : 1);
    return view;
}

void PreparedVolume::add_surfaces(SurfacePicture& seen, std::span<const SplatRecord> lit, const View& view,
                                  Output output) const {
    const SurfacePicture own =
        draw_surfaces(lit, field(), *surface_scene_, scene_of_surfaces(scene_), view, settings_, payload_for(output));
    seen.pixels.resize(own.pixels.size());
    seen.outlines.resize(own.outlines.size());
    for (std::size_t i = 0; i < own.outlines.size(); ++i)
        if (own.outlines[i]) keep_outer(seen.outlines[i], own.outlines[i]);
    for (std::size_t i = 0; i < own.pixels.size(); ++i) {
        const double mm = mm_along(view, i);
        std::array<SeenSurface, 4> all{seen.pixels[i][0], seen.pixels[i][1], own.pixels[i][0], own.pixels[i][1]};
        for (std::size_t k = 2; k < 4; ++k)
            all[k].way *= mm;
        std::ranges::stable_sort(all, {}, &SeenSurface::way);
        seen.pixels[i] = {all[0], all[0].solid ? SeenSurface() : all[1]};
    }
}

Image PreparedVolume::render(const Camera& camera, int width, int height, Output output) const {
    check_picture_size(width, height);
    // Optical depth needs all voxels.
    const bool whole = output == Output::Tau;
    if (whole && !added_.empty()) fail("output tau: is of one volume, but the scene has several");
    std::vector<const PreparedVolume*> surfaces, translucent;
    const auto add_parts = [&](const PreparedVolume& volume) {
        if (const PreparedVolume* part = whole ? nullptr : volume.opaque_part()) surfaces.push_back(part);
        if (const PreparedVolume* part = whole ? &volume : volume.kernel_part()) translucent.push_back(part);
    };
    add_parts(*this);
    for (const auto& volume : added_)
        add_parts(*volume);
    std::vector<LightMatter> matter;
    if (has_matter(lighting_)) matter.push_back(light_matter());
    for (const auto& volume : added_)
        if (has_matter(volume->lighting_)) matter.push_back(volume->light_matter());
    std::vector<std::vector<SplatRecord>> lit;
    for (const PreparedVolume* part : surfaces)
        lit.push_back(part->lit_surfaces(output, matter));
    std::vector<Kernels> kernels;
    for (const PreparedVolume* part : translucent)
        kernels.push_back({part, part->lit_kernels(camera.eye, output, matter)});
    const auto drawn = [&](const glm::dvec2& offset) {
        SurfacePicture seen;
        for (std::size_t i = 0; i < surfaces.size(); ++i)
            surfaces[i]->add_surfaces(seen, lit[i], surfaces[i]->view_of(camera, {width, height}, offset, output),
                                      output);
        if (!kernels.empty())
            return draw(kernels, camera, {width, height}, offset, output, surfaces.empty() ? nullptr : &seen);
        std::vector<glm::dvec4> frame = composited(seen);
        frame.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), glm::dvec4(0));
        if (!seen.outlines.empty()) frame = smoothed(frame, seen.outlines, width, height);
        return resolve(frame, width, height, scene_, output);
    };
    const int samples = output == Output::Color ? scene_.effects.samples : 1;
    if (samples == 1) return drawn({0, 0});
    SampleMean mean({width, height});
    for (const glm::dvec2& offset : sample_offsets(samples))
        mean.add(drawn(offset).pixels);
    return mean.image();
}

void PreparedVolume::replace_surface(std::size_t voxel, const VoxelEdge& edge) {
    const auto at = std::ranges::lower_bound(surfaces_, voxel, {}, &SplatRecord::voxel);
    if (at != surfaces_.end() && at->voxel == voxel) at->edge = edge;
}

namespace {

/// The share of light that all matter lets through; each takes its own.
template <typename Share>
double product(std::span<const LightMatter> matter, const Share& share) {
    double all = 1;
    for (const LightMatter& one : matter)
        all *= share(one);
    return all;
}

}  // namespace

std::vector<SplatRecord> PreparedVolume::lit_surfaces(Output output, std::span<const LightMatter> matter) const {
    std::vector<SplatRecord> lit = surfaces_;
    const std::vector<std::size_t> shadowing = shadow_lights(scene_);
    const bool occludes = occludes_ambient(scene_);
    if (output != Output::Color || (!occludes && shadowing.empty())) return lit;
    const VolumeGeometry& geometry = volume_->geometry;
    parallel_for(static_cast<int>(lit.size()), [&](int begin, int end) {
        for (int i = begin; i < end; ++i) {
            SplatRecord& record = lit[static_cast<std::size_t>(i)];
            // Their second distance is an error, and planes cut rays, not splats.
            VoxelEdge face = record.edge;
            face.D2 = std::numeric_limits<double>::infinity();
            const SurfacePoint point = surface_point(face, edge_reach(settings_), false, geometry);
            if (occludes) {
                const AmbientOcclusion& occlusion = *scene_.effects.occlusion;
                const double reach = product(matter, [&](const LightMatter& one) {
                    return ambient_reach_at(point, field().voxel(record.voxel), geometry, one, occlusion.radius);
                });
                record.reach.ambient = 1 - occlusion.strength * (1 - reach);
            }
            for (const std::size_t l : shadowing)
                record.reach.lights[l] = product(matter, [&](const LightMatter& one) {
                    return light_reach(point, field().voxel(record.voxel), geometry, one, scene_.lights[l]);
                });
        }
    });
    return lit;
}

void PreparedVolume::find_light(std::span<SplatRecord> records, std::span<const LightMatter> matter) const {
    const Field f = field();
    const VolumeGeometry& geometry = volume_->geometry;
    const double band = edge_reach(settings_);
    const IndexClip clip = index_clip(scene_.effects.clip, geometry);
    const std::vector<std::size_t> shadowing = shadow_lights(scene_);
    const auto& occlusion = scene_.effects.occlusion;
    if (!occludes_ambient(scene_) && shadowing.empty()) return;
    parallel_for(static_cast<int>(records.size()), [&](int begin, int end) {
        for (int i = begin; i < end; ++i) {
            SplatRecord& record = records[static_cast<std::size_t>(i)];
            const auto ambient = [&](bool turned) {
                const SurfacePoint point = at_cut(surface_point(record.edge, band, turned, geometry), record.edge,
                                                  glm::dvec3(f.voxel(record.voxel)), clip, geometry);
                const double reach = product(matter, [&](const LightMatter& one) {
                    return ambient_reach_at(point, f.voxel(record.voxel), geometry, one, occlusion->radius);
                });
                return 1 - occlusion->strength * (1 - reach);
            };
            if (occludes_ambient(scene_)) {
                record.reach.ambient = ambient(false);
                record.turned_ambient = is_wall(record.edge, band) ? ambient(true) : record.reach.ambient;
            }
            for (const std::size_t l : shadowing) {
                const SurfacePoint point = lit_point(record, f, geometry, band, scene_.lights[l], clip);
                record.reach.lights[l] = product(matter, [&](const LightMatter& one) {
                    return light_reach(point, f.voxel(record.voxel), geometry, one, scene_.lights[l]);
                });
            }
        }
    });
}

std::vector<SplatRecord> PreparedVolume::lit_kernels(const glm::dvec3& eye, Output output,
                                                     std::span<const LightMatter> matter) const {
    std::vector<SplatRecord> records =
        collect_splats(field(), scaled_, edges_, scene_of_kernels(scene_), volume_->geometry, settings_, eye,
                       output == Output::Tau, classified_, carried_);
    for (SplatRecord& record : records)
        record.weight *= scene_.rim.share(volume_->geometry.to_world(glm::dvec3(field().voxel(record.voxel))));
    if (output == Output::Color) find_light(records, matter);
    return records;
}

namespace {

/// Where the rays of the pixels end at solid surfaces, voxels from the eye. The picture's ways are in mm.
std::vector<double> ends_of(const SurfacePicture& picture, const View& view) {
    std::vector<double> ends;
    for (const auto& surfaces : picture.pixels) {
        const auto solid = std::ranges::find_if(surfaces, &SeenSurface::solid);
        ends.push_back(solid == surfaces.end() ? std::numeric_limits<double>::infinity()
                                               : solid->way / mm_along(view, ends.size()));
    }
    return ends;
}

/// Composites the surfaces of a pixel that lie before `way`, from number `next` on, behind its sum.
void pass_surfaces(glm::dvec4& sum, const std::array<SeenSurface, 2>& surfaces, std::size_t& next, double way) {
    for (; next < surfaces.size() && surfaces[next].way < way; ++next) {
        const SeenSurface& surface = surfaces[next];
        const glm::dvec4 value = surface.solid ? surface.value / surface.value.w : surface.value;
        sum += (1 - sum.w) * value;
    }
}

}  // namespace

/// Kernels of a volume in the sheets of a picture.
class PreparedVolume::DrawnKernels {
  public:
    DrawnKernels(const Kernels& kernels, const View& view, const Sheets& sheets, Output output,
                 const SurfacePicture* behind)
        : view_(view),
          field_(kernels.part->field()),
          ends_(behind ? ends_of(*behind, view) : std::vector<double>{}),
          selected_(select_footprints(kernels.records, field_, view_, kernels.part->settings_,
                                      kernels.part->footprints_, sheets,
                                      index_clip(scene_of_kernels(kernels.part->scene_).effects.clip, view.geometry))),
          sorted_(sort_sheets(selected_)),
          footprints_(
              kernels.part->settings_, table_depth(kernels.part->scene_, view.geometry),
              output != Output::Tau && has_single_piece(kernels.part->settings_, kernels.part->scene_, view.geometry)
                  ? FacePieces::Longer
                  : FacePieces::Both),
          scene_(scene_of_kernels(kernels.part->scene_)),
          drawer_(kernels.records, selected_, field_, scene_, view_, kernels.part->settings_, footprints_, ends_) {}

    std::size_t sheets() const { return sorted_.sheets(); }
    std::span<const std::uint32_t> sheet(std::size_t number) const {
        return number < sheets() ? sorted_.sheet(number) : std::span<const std::uint32_t>();
    }
    /// All splats, each once.
    std::vector<std::uint32_t> all() const {
        std::vector<std::uint32_t> once = sorted_.order;
        std::sort(once.begin(), once.end());
        once.erase(std::unique(once.begin(), once.end()), once.end());
        return once;
    }
    const SplatDrawer& drawer() const { return drawer_; }

  private:
    View view_;
    Field field_;
    std::vector<double> ends_;
    std::vector<Selected> selected_;
    SortedSheets sorted_;
    Footprints footprints_;
    Scene scene_;
    SplatDrawer drawer_;
};

Image PreparedVolume::draw(std::span<const Kernels> kernels, const Camera& camera, const glm::ivec2& size,
                           const glm::dvec2& offset, Output output, const SurfacePicture* behind) {
    // What is the same for all volumes: the picture's size, the camera, background and effects.
    const PreparedVolume& any = *kernels.front().part;
    const Settings& settings = any.settings_;
    const int width = size.x, height = size.y;
    std::vector<View> views;
    Sheets sheets;
    double before = 0;  // how far kernels reach in front of their sheets, mm
    bool smooth = false;
    for (const Kernels& one : kernels) {
        const PreparedVolume& part = *one.part;
        const View& view = views.emplace_back(part.view_of(camera, size, offset, output));
        sheets = sheets.with(sheets_of(one.records, part.field(), view, part.settings_, part.footprints_));
        const double unit = glm::length(glm::transpose(view.geometry.index_to_world_axes) * view.frame.forward);
        before = std::max(before, unit * uncut_kernel(part.settings_, part.scene_, view.geometry).radius);
        smooth = smooth || (output == Output::Color && smooths_outlines(part.settings_, part.scene_));
    }
    std::deque<DrawnKernels> lists;
    std::size_t count = 0;
    for (std::size_t i = 0; i < kernels.size(); ++i)
        count = std::max(count, lists.emplace_back(kernels[i], views[i], sheets, output, behind).sheets());

    const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    std::vector<glm::dvec4> frame(pixels, glm::dvec4(0));
    // Optical depth is a plain sum, so it needs no sheets.
    if (output == Output::Tau) {
        for (const DrawnKernels& list : lists)
            list.drawer().draw(list.all(), Payload::Color, {}, frame);
        return resolve(frame, width, height, any.scene_, output);
    }
    std::vector<char> closed(pixels, 0);
    std::vector<glm::dvec4> sheet(pixels);
    std::vector<std::optional<Outline>> outlines(smooth ? pixels : 0);
    if (smooth && behind) outlines = behind->outlines;
    std::vector<std::size_t> passed(behind ? pixels : 0, 0);
    const View& view = views.front();
    // Surfaces before anything that this sheet, or one behind it, contains.
    const auto pass = [&](double depth) {
        for (std::size_t at = 0; at < passed.size(); ++at) {
            const glm::dvec3 ray = view.geometry.index_to_world_axes *
                                   view.ray(static_cast<int>(at) % width, static_cast<int>(at) / width);
            const double along = glm::dot(view.frame.forward, ray) / glm::length(ray);
            pass_surfaces(frame[at], behind->pixels[at], passed[at], depth / along);
        }
    };
    for (std::size_t s = 0; s < count; ++s) {
        if (s % kSheetsPerGroup == 0) {
            std::transform(frame.begin(), frame.end(), closed.begin(),
                           [&](const glm::dvec4& v) { return v.w >= settings.saturation ? 1 : 0; });
        }
        if (std::ranges::all_of(lists, [&](const DrawnKernels& list) { return list.sheet(s).empty(); })) continue;
        const auto number = static_cast<double>(s);
        pass(sheets.depth(number) - before);
        std::fill(sheet.begin(), sheet.end(), glm::dvec4(0));
        std::optional<DepthRange> cut;
        if (settings.sheets == SheetCut::Sliced) cut = {sheets.depth(number), sheets.depth(number + 1)};
        for (const DrawnKernels& list : lists)
            list.drawer().draw(list.sheet(s), payload_for(output), closed, sheet, cut);
        for (const DrawnKernels& list : lists)
            if (smooth) list.drawer().outline(list.sheet(s), frame, outlines, cut);
        composite_sheet(frame, sheet, closed);
    }
    pass(std::numeric_limits<double>::infinity());
    if (smooth) frame = smoothed(frame, outlines, width, height);
    return resolve(frame, width, height, any.scene_, output);
}

Image render(const Volume& volume, const Scene& scene, const Camera& camera, const Settings& settings, int width,
             int height, Output output) {
    return PreparedVolume(volume, scene, settings).render(camera, width, height, output);
}

}  // namespace edgesplat::reference

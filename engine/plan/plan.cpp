#include "engine/plan/plan.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "engine/error.h"
#include "engine/scene/clip_planes.h"
#include "engine/scene/transfer_function.h"
#include "engine/volume/filters.h"
#include "engine/volume/grid.h"
#include "engine/volume/packed_volume.h"
#include "footprints/face.h"
#include "footprints/paper_warp.h"

namespace edgesplat {

namespace {

// Extinction per voxel from which an interval counts as opaque: it occludes everything a few voxels behind its surface.
constexpr double kBuriesPerVoxel = 0.75;
// Memory of the sheet group, bytes. More layers mean fewer passes, but saturation is tested only between groups: 4 to
// 8 layers measured fastest.
constexpr std::uint64_t kSheetBudget = std::uint64_t{192} << 20U;
constexpr std::uint32_t kMaxSheetsPerGroup = 8;
// Each invocation of 4b_scan_sheets iterates over four counters per sheet.
constexpr double kMaxSheets = shader::MOST_ITERATIONS / 4.0;
// Slices up to this thickness (voxels) need 4 quadrature nodes for an error of 0.003 % of a footprint's peak.
constexpr double kThinSlice = 0.3;
constexpr int kSliceNodes = 4;
constexpr double kFarthestPointLight = 1e12;  // mm

bool is_opaque(double extinction, const VolumeGeometry& geometry) {
    return extinction * shortest_spacing(geometry) >= kBuriesPerVoxel;
}

/// The extinction for the device, limited to 1e20 per voxel: opaque within a voxel, but sums and means over a
/// picture's splats stay in the range of a float.
double bounded(double extinction, const VolumeGeometry& geometry) {
    constexpr double kMostAVoxel = 1e20;
    const glm::dvec3 s = geometry.spacing();
    return std::min(extinction, kMostAVoxel / std::max({s.x, s.y, s.z}));
}

/// Mean of extinction * (colour, 1) between two points; extinction and colour are linear, so Simpson's rule is exact.
glm::dvec4 mean_matter(const TransferPoint& a, const TransferPoint& b) {
    const auto at = [&](double t) {
        const double extinction = std::lerp(a.extinction, b.extinction, t);
        return extinction * glm::dvec4(glm::mix(a.color, b.color, t), 1);
    };
    return (at(0) + 4.0 * at(0.5) + at(1)) / 6.0;
}

std::vector<shader::TransferRow> transfer_rows(const Scene& scene, const Volume& volume) {
    std::vector<shader::TransferRow> rows;
    glm::dvec4 before(0);
    TransferPoint last;
    for (TransferPoint& point : scaled_transfer(scene, volume)) {
        point.extinction = bounded(point.extinction, volume.geometry);
        if (!rows.empty()) before += (point.value - last.value) * mean_matter(last, point);
        rows.push_back({static_cast<float>(point.value), glm::dvec4(point.color, point.extinction), before});
        last = point;
    }
    if (!rows.empty()) rows.resize(shader::TRANSFER_ROWS + 1, {3e38F, rows.back().matter, rows.back().before});
    return rows;
}

/// Voxels behind a surface at which 1/256 of the light remains, plus the kernel's radius.
int bury_distance(double extinction_per_voxel, double radius) {
    return static_cast<int>(std::ceil(radius + std::log(256.0) / extinction_per_voxel));
}

glm::vec3 to_float(const glm::dvec3& v) {
    return {v};
}

/// A light's FrameParams::light_at.
glm::vec4 place_of(const Light& light, const glm::dvec3& eye) {
    switch (light.kind) {
        case Light::Kind::Headlight:
            break;
        case Light::Kind::Directional:
            return {to_float(unit(light.direction)), 0};
        case Light::Kind::Point: {
            const glm::dvec3 place = light.position - eye;
            // From this distance on rays count as parallel: float32 cannot represent the squares of such lengths.
            const bool far = !(glm::length(place) < kFarthestPointLight);
            return far ? glm::vec4(to_float(unit(place)), 0) : glm::vec4(to_float(place), 1);
        }
    }
    return {0, 0, 0, 1};
}

/// FrameParams::shadow_channels.
std::uint32_t shadow_channels(const Scene& scene) {
    std::uint32_t channels = 0, next = 1;
    for (const std::size_t light : shadow_lights(scene))
        channels |= next++ << 4 * light;
    return channels;
}

bool has_own_response(const Material& material) {
    const LightResponse usual;
    const LightResponse& r = material.response;
    return r.ambient != usual.ambient || r.diffuse != usual.diffuse || r.specular != usual.specular;
}

/// Fills in what colours depend on: lights, material responses, effects, the transfer function, labels.
void plan_shading(const Scene& scene, const Volume& volume, const Settings& settings, const glm::dvec3& eye,
                  FramePlan& plan) {
    auto& variant = plan.variant;
    auto& p = plan.params;
    p.ambient = static_cast<float>(scene.ambient);
    for (std::size_t l = 0; l < scene.lights.size(); ++l) {
        const Light& light = scene.lights[l];
        p.light_at[l] = place_of(light, eye);
        p.light_color[l] = glm::vec4(to_float(light.color * light.intensity), 0);
    }
    bool response = false, gloss = false;
    for (std::size_t m = 0; m < scene.materials.size(); ++m) {
        const Material& material = scene.materials[m];
        const LightResponse& r = material.response;
        plan.volume.responses[m] = glm::dvec4(r.ambient, r.diffuse, r.specular, r.shininess);
        if (scene.lights.empty() || !(extinctions_of(scene, m).most > 0)) continue;
        response = response || has_own_response(material);
        gloss = gloss || r.specular > 0;
    }
    if (const auto& silhouette = scene.effects.silhouette) {
        p.silhouette = glm::dvec4(silhouette->color, silhouette->strength);
        p.silhouette_sharpness = static_cast<float>(silhouette->sharpness);
    }
    if (const auto& fog = scene.effects.fog) {
        p.fog = glm::dvec4(fog->color, fog->density);
        p.fog_start = static_cast<float>(fog->start);
    }
    const bool occluded = occludes_ambient(scene);
    if (occluded) p.occlusion_strength = static_cast<float>(scene.effects.occlusion->strength);
    const bool color = variant.payload == shader::PAYLOAD_COLOR;
    variant.shadows = color ? static_cast<std::uint32_t>(shadow_lights(scene).size()) : 0;
    p.shadow_channels = shadow_channels(scene);
    const bool lit_edges = needs_normals(scene) && lights_edges_only(scene, draws_warped(settings));
    const std::uint32_t labels = labels_drawn(scene, volume);
    if (labels != 0) plan.label_colors = label_colors(scene);
    plan.volume.has_transfer = scene.transfer.empty() ? 0 : 1;
    plan.volume.has_labels = labels != 0 ? 1 : 0;
    plan.volume.lit_edges = lit_edges ? 1 : 0;
    variant.shading = {{shader::SPEC_LIGHT, color ? static_cast<std::uint32_t>(scene.lights.size()) : 0},
                       {shader::SPEC_RESPONSE, color && response ? 1 : 0},
                       {shader::SPEC_GLOSS, color && gloss ? 1 : 0},
                       {shader::SPEC_LIT_EDGES, color && lit_edges ? 1 : 0},
                       {shader::SPEC_SILHOUETTE, color && scene.effects.silhouette ? 1 : 0},
                       {shader::SPEC_FOG, color && scene.effects.fog ? 1 : 0},
                       {shader::SPEC_OCCLUSION, color && occluded ? 1 : 0},
                       {shader::SPEC_TRANSFER, scene.transfer.empty() ? 0 : 1},
                       {shader::SPEC_LABELS, labels}};
}

void copy_planes(const std::vector<IndexPlane>& planes, glm::vec4 (&params)[shader::MAX_CLIP_PLANES]) {
    for (std::size_t i = 0; i < planes.size(); ++i)
        params[i] = glm::vec4(to_float(planes[i].normal), static_cast<float>(planes[i].offset));
}

template <typename Enum>
constexpr bool is(Enum value, std::uint32_t constant) {
    return static_cast<std::uint32_t>(value) == constant;
}
static_assert(is(EdgeEstimator::Taylor, shader::TAYLOR) && is(EdgeEstimator::March, shader::MARCH));
static_assert(is(EdgeEstimator::Cubic, shader::CUBIC) && is(FootprintMode::Isotropic, shader::ISOTROPIC));
static_assert(is(FootprintMode::Warp2d, shader::WARP2D) && is(FootprintMode::Procedural, shader::PROCEDURAL));
static_assert(is(FootprintMode::Table, shader::TABLE));
static_assert(is(WarpFamily::Paper, shader::PAPER) && is(WarpFamily::Face, shader::FACE));

}  // namespace

passes::ClipCount place_clip(const Clip& clip, const VolumeGeometry& geometry, const glm::dvec3& origin,
                             glm::vec4 (&keep)[shader::MAX_CLIP_PLANES], glm::vec4 (&remove)[shader::MAX_CLIP_PLANES]) {
    const IndexClip planes = index_clip(clip, geometry, origin);
    copy_planes(planes.keep, keep);
    copy_planes(planes.remove, remove);
    return {static_cast<std::uint32_t>(planes.keep.size()), static_cast<std::uint32_t>(planes.remove.size())};
}

std::uint32_t light_code(const Scene& scene) {
    return scene.lights.empty() ? 0U : 1U + static_cast<std::uint32_t>(scene.lights.front().kind);
}

std::uint32_t labels_drawn(const Scene& scene, const Volume& volume) {
    if (!volume.shown_labels || scene.label_colors.empty()) return 0;
    return volume.has_segmentation() ? shader::LABELS_OF_SCAN : shader::LABELS_OF_MASK;
}

std::vector<glm::vec3> label_colors(const Scene& scene) {
    return {scene.label_colors.begin(), scene.label_colors.end()};
}

bool needs_normals(const Scene& scene) {
    return !scene.lights.empty() || scene.effects.silhouette;
}

namespace {

/// Where a transfer function is above 0: its points, without those whose neighbours are like them.
std::vector<std::pair<float, bool>> support_of(const std::vector<shader::TransferRow>& rows) {
    const auto seen = [&](std::size_t i) { return rows[i].matter.a > 0; };
    std::vector<std::pair<float, bool>> points;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const bool like_before = i == 0 || seen(i - 1) == seen(i);
        const bool like_after = i + 1 == rows.size() || seen(i + 1) == seen(i);
        if (!like_before || !like_after) points.emplace_back(rows[i].value, seen(i));
    }
    if (points.empty() && !rows.empty()) points.emplace_back(0.0F, seen(0));
    return points;
}

bool same_intervals(const CollectionPlan& a, const CollectionPlan& b) {
    return a.dims == b.dims && a.blocks == b.blocks && a.params.iso_count == b.params.iso_count &&
           std::ranges::equal(a.params.iso, b.params.iso);
}

/// Inputs of pass 1a.
bool same_mask(const CollectionPlan& a, const CollectionPlan& b) {
    return same_intervals(a, b) && a.buried == b.buried && a.params.opaque_mask == b.params.opaque_mask &&
           a.params.bury_distance == b.params.bury_distance && a.clip == b.clip &&
           std::ranges::equal(a.params.opaque_iso, b.params.opaque_iso) &&
           std::ranges::equal(a.params.clip_keep, b.params.clip_keep) &&
           std::ranges::equal(a.params.clip_remove, b.params.clip_remove);
}

/// Inputs of pass 1b, apart from the mask.
bool same_edges(const CollectionPlan& a, const CollectionPlan& b) {
    // Beside which materials a voxel lies is stored with a surfel, else only if there is translucent matter.
    const bool surfels = b.estimator == EdgeEstimator::March || b.estimator == EdgeEstimator::Cubic;
    return same_intervals(a, b) && a.estimator == b.estimator && a.edge_field == b.edge_field &&
           a.skip_buried == b.skip_buried && a.surfaces == b.surfaces &&
           a.params.estimate_mask == b.params.estimate_mask && a.params.band == b.params.band &&
           a.params.reach == b.params.reach &&
           (surfels || (a.params.translucent_mask != 0) == (b.params.translucent_mask != 0));
}

}  // namespace

StaleResults stale_results(const CollectionPlan& held, const CollectionPlan& wanted) {
    StaleResults stale;
    stale.mask = !same_mask(held, wanted);
    stale.edges = !same_edges(held, wanted) || (wanted.skip_buried && stale.mask);
    stale.lists = stale.mask || stale.edges || held.faces != wanted.faces || held.two_values != wanted.two_values ||
                  held.labels != wanted.labels || held.params.visible_mask != wanted.params.visible_mask ||
                  held.params.translucent_mask != wanted.params.translucent_mask ||
                  support_of(held.transfer) != support_of(wanted.transfer);
    stale.transfer = !std::ranges::equal(held.transfer, wanted.transfer);
    return stale;
}

bool CollectionPlan::operator==(const CollectionPlan& other) const {
    const StaleResults stale = stale_results(*this, other);
    return !stale.lists && !stale.transfer;
}

void place_iso_values(const Volume& volume, std::span<const double> values, float (&iso)[16]) {
    std::fill(std::begin(iso), std::end(iso), 3e38F);
    for (std::size_t j = 0; j < values.size(); ++j)
        iso[j] = static_cast<float>(scaled_iso_value(volume, values[j]));
}

std::uint32_t material_of(std::span<const float> iso, float scaled) {
    return static_cast<std::uint32_t>(std::ranges::count_if(iso, [&](float value) { return value <= scaled; }));
}

std::uint32_t faces_with_matter(const Volume& volume, const shader::SceneParams& params) {
    const glm::ivec3 last = volume.geometry.dims - 1;
    const auto value = [&](const glm::ivec3& i) { return scaled_sample(volume, value_at(volume, i)); };
    const auto is_matter = [&](float f) { return (params.visible_mask >> material_of(params.iso, f) & 1U) != 0; };
    const auto in_layer = [&](int axis, bool high) {
        const int across = (axis + 1) % 3, down = (axis + 2) % 3;
        glm::ivec3 i(0);
        i[axis] = high ? last[axis] : 0;
        for (i[across] = 0; i[across] <= last[across]; ++i[across])
            for (i[down] = 0; i[down] <= last[down]; ++i[down]) {
                glm::ivec3 before = i;
                before[axis] = std::clamp(high ? i[axis] - 1 : i[axis] + 1, 0, last[axis]);
                const float here = value(i), beyond = 2 * here - value(before);
                if (is_matter(here) || is_matter(beyond)) return true;
            }
        return false;
    };
    std::uint32_t faces = 0;
    for (int axis = 0; axis < 3; ++axis)
        for (const bool high : {false, true})
            if (in_layer(axis, high)) faces |= face_of_volume(axis, high);
    return faces;
}

std::uint32_t faces_in_sight(const glm::ivec3& dims, const glm::dvec3& eye) {
    std::uint32_t faces = 0;
    for (int axis = 0; axis < 3; ++axis) {
        if (!(eye[axis] > -0.5)) faces |= face_of_volume(axis, false);
        if (!(eye[axis] < dims[axis] - 0.5)) faces |= face_of_volume(axis, true);
    }
    return faces;
}

namespace {

/// Whether the field may be matter at a point in the volume (index space), as 5_begin_surfaces asks.
bool may_be_matter(const Volume& volume, const shader::VolumeParams& params, const glm::dvec3& at) {
    const glm::ivec3 last = volume.geometry.dims - 1,
                     cell = glm::clamp(glm::ivec3(glm::floor(at)), glm::ivec3(0), last);
    float least = INFINITY, most = -INFINITY;
    for (int i = 0; i < 8; ++i) {
        const glm::ivec3 corner = glm::min(cell + glm::ivec3(i & 1, i >> 1 & 1, i >> 2), last);
        const float value = scaled_sample(volume, value_at(volume, corner));
        least = std::min(least, value);
        most = std::max(most, value);
    }
    const float doubt = shader::SURFACE_DOUBT * (most - least);
    const std::uint32_t last_material = material_of(params.iso, most + doubt);
    for (std::uint32_t m = material_of(params.iso, least - doubt); m <= last_material; ++m)
        if ((params.visible_mask >> m & 1U) != 0) return true;
    return false;
}

}  // namespace

CollectionPlan plan_collection(const Volume& volume, const Scene& drawn, const Settings& settings, bool keep_buried,
                               const Scene* whole) {
    CollectionPlan plan;
    // Optical depth needs all voxels.
    plan.surfaces = !keep_buried && draws_surfaces(settings, drawn, volume);
    const Scene& scene = plan.surfaces ? scene_of_bodies(drawn) : drawn;
    const Scene& opaque = whole ? *whole : scene;
    plan.dims = volume.geometry.dims;
    plan.estimator = draws_warped(settings) ? settings.edges : EdgeEstimator::Off;
    plan.edge_field = plan.estimator != EdgeEstimator::Off || needs_normals(scene);

    auto& params = plan.params;
    params.dims = plan.dims;
    params.iso_count = static_cast<std::uint32_t>(scene.iso_values.size());
    place_iso_values(volume, scene.iso_values, params.iso);
    plan.transfer = transfer_rows(scene, volume);
    const double radius = uncut_kernel(settings, scene, volume.geometry).radius;
    for (std::size_t m = 0; m < scene.materials.size(); ++m)
        if (extinctions_of(scene, m).most > 0) params.visible_mask |= 1U << m;
    params.opaque_count = static_cast<std::uint32_t>(opaque.iso_values.size());
    place_iso_values(volume, opaque.iso_values, params.opaque_iso);
    int farthest = 0;
    for (std::size_t m = 0; m < opaque.materials.size(); ++m) {
        const double least = extinctions_of(opaque, m).least;
        if (!is_opaque(least, volume.geometry)) continue;
        params.opaque_mask |= 1U << m;
        farthest = std::max(farthest, bury_distance(least * shortest_spacing(volume.geometry), radius));
    }
    // No surface splat is buried.
    plan.buried = settings.cull_buried && !keep_buried && !plan.surfaces && params.opaque_mask != 0 &&
                  farthest <= shader::MAX_BURY_DISTANCE;
    plan.skip_buried = plan.buried && std::has_single_bit(params.opaque_mask);
    params.bury_distance = plan.buried ? farthest : 0;
    if (!plan.buried) params.opaque_mask = 0;
    if (plan.buried)
        plan.clip =
            place_clip(scene.effects.clip, volume.geometry, glm::dvec3(0), params.clip_keep, params.clip_remove);
    params.band = static_cast<float>(edge_reach(settings));
    plan.faces = draws_faces(settings);
    plan.two_values = (plan.surfaces || plan.faces) && volume.two_values;
    const double range = static_cast<double>(volume.max_value) - static_cast<double>(volume.min_value);
    if (plan.surfaces && range > 0) params.noise = static_cast<float>(volume.noise / range);
    plan.labels = labels_drawn(scene, volume);
    params.reach = static_cast<float>(kernel_reach(settings));
    params.translucent_mask = materials_carried_beside(settings, scene, volume.geometry);
    // A face is fitted to both sides of a surface, also to a side that is not drawn.
    params.estimate_mask = plan.faces ? ~0U : params.visible_mask;
    return plan;
}

bool eye_in_opaque(const Volume& volume, const Scene& scene, const Camera& camera) {
    if (index_clip(scene.effects.clip, volume.geometry).cuts_away(volume.geometry.to_index(camera.eye))) return false;
    const auto index = glm::round(volume.geometry.to_index(camera.eye));
    const glm::dvec3 last(volume.geometry.dims - 1);
    if (!glm::all(glm::greaterThanEqual(index, glm::dvec3(0))) || !glm::all(glm::lessThanEqual(index, last)))
        return false;
    const glm::ivec3 voxel(index);
    if (!volume.has_data(voxel)) return false;
    const auto value = static_cast<double>(value_at(volume, voxel));
    const auto above = std::upper_bound(scene.iso_values.begin(), scene.iso_values.end(), value);
    const auto material = static_cast<std::size_t>(above - scene.iso_values.begin());
    return is_opaque(extinctions_of(scene, material).least, volume.geometry);
}

double sheet_thickness(const VolumeGeometry& geometry, const Camera& camera, const Settings& settings) {
    const glm::dmat3 to_index = glm::inverse(geometry.index_to_world_axes);
    return settings.sheet_spacing / glm::length(to_index * camera_frame(camera).forward);
}

namespace {

/// Fills in the materials by value.
void plan_matter(const Volume& volume, const Scene& scene, FramePlan& plan) {
    auto& v = plan.volume;
    plan.variant.iso_count = static_cast<std::uint32_t>(scene.iso_values.size());
    place_iso_values(volume, scene.iso_values, v.iso);
    for (std::size_t m = 0; m < scene.materials.size(); ++m)
        if (scene.materials[m].extinction > 0) v.visible_mask |= 1U << m;
    v.solid = static_cast<float>(solid_chord(scene, volume.geometry));
}

/// Fills in where kernels of one volume give way to those of another, or where surfaces of one continue the other's.
void place_rim(const Rim& rim, const VolumeGeometry& geometry, const glm::dvec3& anchor, FramePlan& plan) {
    auto& v = plan.volume;
    v.rim_within = rim.within ? 1 : 0;
    // Without a rim all is outside, and no surface continues.
    std::ranges::fill(v.rim, glm::vec4(0, 0, 0, -1));
    if (plan.variant.surfaces) {
        for (std::size_t i = 0; i < rim.sides.size(); ++i) {
            if (!rim.sides[i].inner) continue;
            const IndexPlane plane = index_clip({.keep = {rim.sides[i].plane}, .remove = {}}, geometry, anchor).keep[0];
            v.rim[i] = glm::dvec4(plane.normal, plane.offset);
            plan.variant.inner = true;
        }
        return;
    }
    plan.variant.rim = rim.any();
    constexpr double kSharp = 1e-3;  // mm
    for (std::size_t i = 0; i < rim.sides.size(); ++i) {
        const RimSide& side = rim.sides[i];
        const double width = side.inner ? rim.width : kSharp;
        const glm::dvec3 inwards = -side.plane.normal / width;
        v.rim[i] = glm::dvec4(glm::transpose(geometry.index_to_world_axes) * inwards,
                              glm::dot(inwards, geometry.to_world(anchor) - side.plane.point));
        if (!side.inner && rim.within) v.rim[i] = glm::vec4(0, 0, 0, 1);
    }
}

}  // namespace

double SplatDepths::least_thickness() const {
    // The first and the last may be cut.
    return (farthest - std::max(nearest, 0.0)) / (kMaxSheets - 2);
}

void place_sheets(FramePlan& plan) {
    const SplatDepths& depths = plan.depths;
    const double thickness = depths.thickness;
    if (plan.variant.sliced)
        plan.sheets_per_splat =
            static_cast<std::uint32_t>(std::min(std::floor(2 * depths.reach / thickness), 32766.0)) + 2;
    const double base = std::floor(std::max(depths.nearest, 0.0) / thickness);
    const double sheets = std::max(std::floor(depths.farthest / thickness) - base + 1.0, 1.0);
    if (!(sheets <= kMaxSheets) || !(base < 2e9)) {
        fail(
            "the view needs {:.0f} sheets of {:.4g} mm, starting at sheet {:.0f}; at most {:.0f} are possible: choose "
            "a larger --sheet-spacing",
            sheets, thickness, base, kMaxSheets);
    }
    auto& p = plan.params;
    const std::uint64_t layer_bytes = 16 * static_cast<std::uint64_t>(p.size.x) * static_cast<std::uint64_t>(p.size.y);
    p.sheet_thickness = static_cast<float>(thickness);
    p.sheet_base = static_cast<int>(base);
    plan.volume.sheet_zero = static_cast<float>(base * thickness - depths.anchor);
    p.sheet_count = static_cast<std::uint32_t>(sheets);
    p.sheets_per_group = static_cast<std::uint32_t>(
        std::clamp<std::uint64_t>(kSheetBudget / layer_bytes, 1, std::min(kMaxSheetsPerGroup, p.sheet_count)));
    p.group_count = (p.sheet_count + p.sheets_per_group - 1) / p.sheets_per_group;
}

FramePlan plan_frame(const Volume& volume, const Scene& scene, const Camera& camera, const Settings& settings,
                     const glm::ivec2& size, std::uint32_t payload, const SplatExtent& splats, double farthest_reach,
                     bool refines) {
    const auto& geometry = volume.geometry;
    const glm::dmat3 to_world = geometry.index_to_world_axes, to_index = glm::inverse(to_world);
    const CameraFrame view = camera_frame(camera);
    const glm::dvec3 down = -view.up;
    const glm::dvec3 anchor = 0.5 * (glm::dvec3(splats.low) + glm::dvec3(splats.high));
    const glm::dvec3 anchor_view = geometry.to_world(anchor) - view.eye;
    const double voxel_along_view = 1.0 / glm::length(to_index * view.forward);

    FramePlan plan;
    // Only colour pictures have several samples; a light's picture has no effects.
    const int samples = payload == shader::PAYLOAD_COLOR ? scene.effects.samples : 1;
    // Optical depth is a plain sum, so slicing does not change it.
    const bool sliced = settings.sheets == SheetCut::Sliced && payload != shader::PAYLOAD_TAU;
    plan.variant = {.footprints = settings.footprints,
                    .warp = settings.warp,
                    .payload = payload,
                    .sliced = sliced,
                    .nodes = static_cast<std::uint32_t>(
                        sliced && settings.sheet_spacing <= kThinSlice                          ? kSliceNodes
                        : settings.warp == WarpFamily::Face && table_depth(scene, geometry) > 0 ? kFewNodes
                                                                                                : kManyNodes)};
    plan.variant.creases = splats.creases && draws_faces(settings);
    plan.variant.tiles = settings.sheet_format == SheetFormat::Tiles;
    plan.wide_marks = static_cast<std::uint64_t>(size.x) * static_cast<std::uint64_t>(size.y) > shader::MARK_PIXELS;
    plan.refined = refines && plan.variant.tiles && payload == shader::PAYLOAD_COLOR &&
                   settings.pixels == PixelChoice::Refined &&
                   std::int64_t{size.x} * size.y <= std::int64_t{shader::REFINE_PIXELS};
    plan.may_refine = plan.refined;
    plan_shading(scene, volume, settings, view.eye, plan);
    if (!draws_warped(settings)) plan.variant.footprints = FootprintMode::Isotropic;

    auto& p = plan.params;
    auto& v = plan.volume;
    plan.variant.clip = place_clip(scene.effects.clip, geometry, anchor, v.clip_keep, v.clip_remove);
    v.anchor = to_float(anchor);
    plan.variant.surfaces = payload != shader::PAYLOAD_TAU && splats.surfaces;
    plan.variant.narrow = draws_opaque_faces(settings, scene, geometry);
    v.support = static_cast<float>(uncut_kernel(settings, scene, geometry).radius);
    if (plan.variant.surfaces) plan_matter(volume, scene, plan);
    place_rim(scene.rim, geometry, anchor, plan);
    const glm::dvec3 eye = geometry.to_index(view.eye);
    const std::uint32_t entered = faces_in_sight(geometry.dims, eye);
    const bool begins = entered == 0 ? may_be_matter(volume, v, eye) : (entered & splats.border) != 0;
    plan.variant.begins = plan.variant.surfaces && (plan.variant.clip.any() || begins);
    if (plan.variant.surfaces && splats.count >= shader::NUMBERED_SPLATS - shader::MAX_MATERIALS)
        fail("{} surface splats are too many, expected less than 2^28: choose --opaque kernels", splats.count);
    const PaperShape paper;
    p.footprint = {.paper_inset = static_cast<float>(paper.inset),
                   .paper_rise = static_cast<float>(paper.rise),
                   .paper_smooth = 0,
                   .paper_reach = static_cast<float>(kPaperReach)};
    v.view_x = to_float(glm::transpose(to_world) * view.right);
    v.view_y = to_float(glm::transpose(to_world) * down);
    v.view_z = to_float(glm::transpose(to_world) * view.forward);
    v.anchor_x = static_cast<float>(glm::dot(view.right, anchor_view));
    v.anchor_y = static_cast<float>(glm::dot(down, anchor_view));
    v.anchor_z = static_cast<float>(glm::dot(view.forward, anchor_view));
    v.eye = to_float(to_index * -anchor_view);
    p.tan_half_x = static_cast<float>(view.tan_half_y * size.x / size.y);
    p.tan_half_y = static_cast<float>(view.tan_half_y);
    v.ray_x = to_float(to_index * view.right);
    v.ray_y = to_float(to_index * down);
    v.ray_z = to_float(to_index * view.forward);
    v.near_depth = static_cast<float>(voxel_along_view);
    v.index_to_world = glm::mat3(to_world);
    v.normal_to_world = glm::mat3(glm::transpose(to_index));
    p.background = to_float(scene.background);
    plan.gradient = payload == shader::PAYLOAD_COLOR && scene.effects.background_top.has_value();
    if (plan.gradient) p.background_top = to_float(*scene.effects.background_top);
    for (std::size_t m = 0; m < scene.materials.size(); ++m) {
        v.materials[m] = glm::vec4(to_float(scene.materials[m].color),
                                   static_cast<float>(bounded(scene.materials[m].extinction, volume.geometry)));
    }

    v.band = static_cast<float>(edge_reach(settings));
    v.translucent_mask = materials_carried_beside(settings, scene, geometry);
    v.table_depth = static_cast<float>(table_depth(scene, geometry));
    plan.variant.antialias = scene.effects.antialias;
    plan.variant.outlines = payload == shader::PAYLOAD_COLOR && smooths_outlines(settings, scene);
    plan.variant.opaque = payload != shader::PAYLOAD_TAU && has_single_piece(settings, scene, geometry);
    plan.variant.traced = plan.variant.surfaces && splats.traced;
    if (plan.variant.antialias) p.pixel = 2.0F * glm::vec2(p.tan_half_x, p.tan_half_y) / glm::vec2(size * samples);

    double nearest = std::numeric_limits<double>::max(), farthest = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::bvec3 high((corner & 1) != 0, (corner & 2) != 0, (corner & 4) != 0);
        const glm::dvec3 at = glm::mix(glm::dvec3(splats.low), glm::dvec3(splats.high), high);
        const double z = glm::dot(view.forward, geometry.to_world(at) - view.eye);
        nearest = std::min(nearest, z);
        farthest = std::max(farthest, z);
    }
    const double reach = glm::length(glm::transpose(to_world) * view.forward) * farthest_reach;
    if (sliced) {
        nearest -= reach;
        farthest += reach;
    }
    plan.depths = {.nearest = nearest,
                   .farthest = farthest,
                   .anchor = glm::dot(view.forward, anchor_view),
                   .reach = reach,
                   .thickness = sheet_thickness(geometry, camera, settings)};
    p.size = size;
    place_sheets(plan);
    v.dims = geometry.dims;
    p.tiles = (size + static_cast<int>(shader::TILE) - 1) / static_cast<int>(shader::TILE);
    draw_first(plan, static_cast<std::uint32_t>(splats.count));
    plan.reach = farthest_reach;
    // Optical depth never saturates: the sum is no opacity.
    p.saturation =
        payload == shader::PAYLOAD_TAU || settings.saturation >= 1 ? 3e38F : static_cast<float>(settings.saturation);
    return plan;
}

void shift_rays(FramePlan& plan, const glm::dvec2& offset) {
    // A sheared view: drawn slopes = ray slopes - slopes of the offset.
    const auto& p = plan.params;
    auto& v = plan.volume;
    const glm::vec2 slopes = glm::vec2(offset) * 2.0F * glm::vec2(p.tan_half_x, p.tan_half_y) / glm::vec2(p.size);
    v.view_x -= slopes.x * v.view_z;
    v.view_y -= slopes.y * v.view_z;
    v.anchor_x -= slopes.x * v.anchor_z;
    v.anchor_y -= slopes.y * v.anchor_z;
    v.ray_z += slopes.x * v.ray_x + slopes.y * v.ray_y;
}

}  // namespace edgesplat

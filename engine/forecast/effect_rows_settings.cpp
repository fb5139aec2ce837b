// Effects that settings enable.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "engine/forecast/effect_rows.h"
#include "engine/forecast/forecast.h"
#include "engine/scene/transfer_function.h"
#include "shaders/shared/limits.h"

namespace edgesplat {

void cut_at_faces(FrameRequest& request) {
    request.settings.edges = EdgeEstimator::March;
    request.settings.footprints = FootprintMode::Procedural;
    request.settings.warp = WarpFamily::Face;
}

void make_opaque(FrameRequest& request) {
    const glm::dvec3 spacing = request.volume->geometry.spacing();
    double& extinction = request.scene.materials.back().extinction;
    extinction = std::max(extinction, 2 / std::min({spacing.x, spacing.y, spacing.z}));
}

namespace {

/// Only the highest values are matter, and opaque.
void show_opaque_matter(FrameRequest& request) {
    cut_at_faces(request);
    request.settings.edges = EdgeEstimator::Cubic;
    const glm::dvec3 spacing = request.volume->geometry.spacing();
    for (Material& material : request.scene.materials)
        material.extinction = 0;
    request.scene.materials.back().extinction = 8 / std::min({spacing.x, spacing.y, spacing.z});
}

/// Only the highest values are matter, and translucent.
void show_translucent_matter(FrameRequest& request) {
    show_opaque_matter(request);
    request.scene.materials.back().extinction /= 80;
}

void draw_opaque_surfaces(FrameRequest& request) {
    request.settings.opaque = OpaqueMatter::Surfaces;
    // Without faces on the spline there are none.
    if (draws_faces(request.settings)) request.settings.edges = EdgeEstimator::Cubic;
}

void make_second_translucent(FrameRequest& request) {
    draw_opaque_surfaces(request);
    request.scene.materials[request.scene.materials.size() - 2] = {{0.3, 0.5, 1}, 0.1};
}

/// The highest values are opaque matter, those below translucent.
void show_mixture(FrameRequest& request) {
    show_opaque_matter(request);
    draw_opaque_surfaces(request);
    make_second_translucent(request);
}

/// Adds the volume again, at another place.
void add_moved_volume(FrameRequest& request, std::vector<double> iso_values, std::vector<Material> materials) {
    auto moved = std::make_shared<Volume>(*request.volume);
    moved->geometry.origin += 0.3 * moved->geometry.index_to_world_axes * glm::dvec3(moved->geometry.dims);
    request.scene.added.push_back({.volume = std::move(moved),
                                   .iso_values = std::move(iso_values),
                                   .materials = std::move(materials),
                                   .transfer = {},
                                   .label_colors = request.scene.label_colors});
}

/// Number of the parts that kernels draw.
std::size_t kernels_of(std::span<const FrameRequest> parts) {
    const auto are_kernels = [](const FrameRequest& part) { return !planned_collection(part).surfaces; };
    return static_cast<std::size_t>(std::ranges::count_if(parts, are_kernels));
}

bool is_mixed(const FrameRequest& request) {
    const std::vector<FrameRequest> parts = drawn_parts(request);
    const std::size_t kernels = kernels_of(parts);
    return kernels > 0 && kernels < parts.size();
}

std::size_t volumes_of(std::span<const FrameRequest> parts) {
    std::set<std::size_t> numbers;
    for (const FrameRequest& part : parts)
        numbers.insert(part.number);
    return numbers.size();
}

}  // namespace

std::vector<Effect> settings_effects() {
    std::vector<Effect> rows;
    rows.push_back(
        {.name = "edge preservation",
         .help =
             "kernels are cut at the surface, a quadric fitted once, and shaded where rays meet it: the surface stays "
             "sharp at any distance",
         .call = "settings.edges, warp and footprints; --edges, --warp, --footprints (on by default)",
         .reason = [](const FrameRequest& r) -> std::string {
             const Settings s = drawn_settings(r);
             if (!draws_warped(s)) return "";
             return draws_faces(s)
                        ? fmt::format("edges are estimated ({}), kernels are cut at faces", name_of(s.edges))
                        : fmt::format("edges are estimated ({}), kernels are warped by the paper's curve ({})",
                                      name_of(s.edges), name_of(s.footprints));
         },
         .turn_on = cut_at_faces,
         .passes = {"1_estimate_edges"},
         .resources = {"edge field", "listed bricks", "splat traits"},
         .resized = {"prepared splats", "tile entries", "marks of tile entries"},
         .record = {{"bending", 8}},
         .constants = {{shader::SPEC_ESTIMATOR, "SPEC_ESTIMATOR"},
                       {shader::SPEC_FOOTPRINTS, "SPEC_FOOTPRINTS"},
                       {shader::SPEC_EDGES, "SPEC_EDGES"},
                       {shader::SPEC_FACES, "SPEC_FACES"}},
         .frame_fields = {"footprint"},
         .volume_fields = {"traits"},
         .scene_fields = {"traits"}});
    rows.push_back({.name = "spline edges",
                    .help = "edges are estimated on the cubic B-spline through the samples",
                    .call = "settings.edges = \"cubic\"; --edges cubic",
                    .reason = [](const FrameRequest& r) -> std::string {
                        const Settings s = drawn_settings(r);
                        return draws_warped(s) && s.edges == EdgeEstimator::Cubic ? "edges are estimated by `cubic`"
                                                                                  : "";
                    },
                    .turn_on = [](FrameRequest& r) { r.settings.edges = EdgeEstimator::Cubic; },
                    .base = cut_at_faces,
                    .resources = {"B-spline coefficients"},
                    .constants = {{shader::SPEC_ESTIMATOR, "SPEC_ESTIMATOR", 2}}});
    rows.push_back({.name = "surface splats",
                    .help = "opaque matter is a surface: splats vote where a ray enters it, and a pixel is shaded once",
                    .call = "settings.opaque = \"surfaces\"; --opaque surfaces (on by default)",
                    .reason = [](const FrameRequest& r) -> std::string {
                        const std::vector<FrameRequest> parts = drawn_parts(r);
                        if (!planned_collection(parts.front()).surfaces) return "";
                        return is_mixed(r) ? "some matter is opaque" : "all matter is opaque";
                    },
                    .turn_on = draw_opaque_surfaces,
                    .base = show_opaque_matter,
                    .passes = {"5_draw_surfaces", "5_shade_surfaces", "5_trace_faces"},
                    .resources = {"traced rays", "traced entries"},
                    .resized = {"batches of splats", "prepared splats", "sheets of splats", "splat list", "splat order",
                                "splat traits", "tiles of splats", "unfinished sheets"},
                    .constants = {{shader::SPEC_SURFACES, "SPEC_SURFACES"}},
                    .frame_fields = {"sheets_drawn"},
                    .volume_fields = {"iso", "solid", "visible_mask"},
                    .scene_fields = {"noise"}});
    rows.push_back(
        {.name = "opaque behind translucent",
         .help = "surface splats draw the opaque matter, kernels the translucent matter in front of it",
         .call = "scene.materials of both kinds, with settings.opaque = \"surfaces\" (on by default)",
         .reason = [](const FrameRequest& r) -> std::string {
             return is_mixed(r) ? "some matter is translucent, some opaque" : "";
         },
         .turn_on = [](FrameRequest& r) { make_second_translucent(r); },
         .base =
             [](FrameRequest& r) {
                 show_opaque_matter(r);
                 draw_opaque_surfaces(r);
             },
         .passes = {"5_draw_tiles", "6_join_surfaces"},
         .resources = {"ends of tiles", "passed surfaces", "seen surfaces", "ways to surfaces"},
         .resized = {"batches of splats", "chunks of sheets", "listed bricks", "pairs of sheets", "prepared splats",
                     "run offsets", "scene parameters", "sheet starts", "sheets of splats", "sort counters",
                     "splat list", "splat order", "splat traits", "tiles of splats"},
         .constants = {{shader::SPEC_MIXED, "SPEC_MIXED"}},
         .frame_fields = {"seen_surfaces", "seen_ways", "surfaces_passed", "tile_ends"}});
    rows.push_back(
        {.name = "several volumes",
         .help = "surfaces of several volumes are drawn one volume after another; each ray keeps the first two",
         .call = "scene.added; [[volumes]] in a scene file, or several volumes on the command line",
         .reason = [](const FrameRequest& r) -> std::string {
             const std::vector<FrameRequest> parts = drawn_parts(r);
             const bool surfaces = kernels_of(parts) < parts.size();
             return surfaces && are_of_several_volumes(parts) ? fmt::format("{} volumes have matter", volumes_of(parts))
                                                              : "";
         },
         .turn_on =
             [](FrameRequest& r) {
                 draw_opaque_surfaces(r);
                 add_moved_volume(r, {r.scene.iso_values.back()}, {{}, r.scene.materials.back()});
             },
         .base =
             [](FrameRequest& r) {
                 show_opaque_matter(r);
                 draw_opaque_surfaces(r);
             },
         .passes = {"6_merge_surfaces", "6_join_surfaces"},
         .resources = {"ends of tiles", "nearest surfaces", "passed surfaces", "seen surfaces",
                       "ways to nearest surfaces", "ways to surfaces"},
         .resized = {"B-spline coefficients", "edge field", "listed bricks", "run offsets", "scene parameters",
                     "splat list", "splat traits", "volume"},
         .constants = {{shader::SPEC_MIXED, "SPEC_MIXED"}},
         .frame_fields = {"nearest_surfaces", "nearest_ways", "seen_surfaces", "seen_ways", "surfaces_passed",
                          "tile_ends"}});
    rows.push_back({.name = "translucent volumes",
                    .help = "kernels of several volumes, each on its own grid, are sorted and drawn as one list",
                    .call = "scene.added; [[volumes]] in a scene file, or several volumes on the command line",
                    .reason = [](const FrameRequest& r) -> std::string {
                        const std::size_t count = kernels_of(drawn_parts(r));
                        return count > 1 ? fmt::format("{} volumes have translucent matter", count) : "";
                    },
                    .turn_on =
                        [](FrameRequest& r) {
                            add_moved_volume(r, {r.scene.iso_values.back()}, {{}, r.scene.materials.back()});
                        },
                    .base = show_translucent_matter,
                    .resized = {"B-spline coefficients", "batches of splats", "chunks of sheets", "edge field",
                                "listed bricks", "pairs of sheets", "prepared splats", "run offsets",
                                "scene parameters", "sheet starts", "sheets of splats", "sort counters", "splat list",
                                "splat order", "splat traits", "tiles of splats", "volume"},
                    .constants = {{shader::SPEC_TOGETHER, "SPEC_TOGETHER"}},
                    .frame_fields = {"volume_count"},
                    .volume_fields = {"first_splat"}});
    rows.push_back(
        {.name = "volume inside",
         .help = "a finer volume replaces the others within its grid; along a rim their kernels give way to its own",
         .call = "scene.added[].replaces; volume.rule = \"inside\"",
         .reason = [](const FrameRequest& r) -> std::string {
             const auto replaces = [](const AddedVolume& added) { return added.replaces; };
             return std::ranges::any_of(r.scene.added, replaces) ? "one volume replaces the others" : "";
         },
         .turn_on =
             [](FrameRequest& r) {
                 if (r.scene.added.empty()) add_moved_volume(r, r.scene.iso_values, r.scene.materials);
                 draw_opaque_surfaces(r);
                 r.scene.added.back().replaces = true;
             },
         .base =
             [](FrameRequest& r) {
                 show_mixture(r);
                 add_moved_volume(r, r.scene.iso_values, r.scene.materials);
             },
         .passes = {"5_begin_surfaces"},
         .constants = {{shader::SPEC_RIM, "SPEC_RIM"}, {shader::SPEC_INNER, "SPEC_INNER"}},
         .volume_fields = {"rim", "rim_within"}});
    rows.push_back({.name = "footprint table",
                    .help = "footprints of plane faces are read from a table whose layers pass 3 selects and rotates",
                    .call = "settings.footprints = \"table\"; --footprints table",
                    .reason = [](const FrameRequest& r) -> std::string {
                        return draws_table(drawn_settings(r)) ? "footprints are read from the `table`" : "";
                    },
                    .turn_on = [](FrameRequest& r) { r.settings.footprints = FootprintMode::Table; },
                    .base = cut_at_faces,
                    .resources = {"footprint table", "selected footprints"},
                    .resized = {"prepared splats", "tile entries", "marks of tile entries"},
                    .record = {{"footprint", 8}},
                    .constants = {{shader::SPEC_FOOTPRINTS, "SPEC_FOOTPRINTS", shader::PROCEDURAL}},
                    .frame_fields = {"footprints"}});
    rows.push_back({.name = "sliced sheets",
                    .help = "kernels are cut at the planes between sheets, which avoids popping when the eye moves",
                    .call = "settings.sheets = \"sliced\"; --sheets sliced",
                    .reason = [](const FrameRequest& r) -> std::string {
                        if (drawn_settings(r).sheets != SheetCut::Sliced) return "";
                        return fmt::format("sheets are `sliced`, {} voxel apart", r.settings.sheet_spacing);
                    },
                    .turn_on = [](FrameRequest& r) { r.settings.sheets = SheetCut::Sliced; },
                    .resized = {"splat order", "sort counters", "pairs of sheets", "sheet starts", "chunks of sheets",
                                "prepared splats"},
                    .constants = {{shader::SPEC_SLICED, "SPEC_SLICED"}, {shader::SPEC_NODES, "SPEC_NODES", 6}}});
    rows.push_back({.name = "refined pixels",
                    .help = "in smooth parts one pixel of 4 or 16 is drawn; the others are interpolated",
                    .call = "settings.pixels = \"refined\"; --pixels refined (on by default)",
                    .reason = [](const FrameRequest& r) -> std::string {
                        const Settings s = drawn_settings(r);
                        const bool refined = s.pixels == PixelChoice::Refined && s.sheet_format == SheetFormat::Tiles;
                        return refined ? "pixels are `refined`" : "";
                    },
                    .turn_on = [](FrameRequest& r) { r.settings.pixels = PixelChoice::Refined; },
                    .base =
                        [](FrameRequest& r) {
                            // A close view, so that splats are many pixels wide.
                            r.settings.pixels = PixelChoice::Every;
                            r.camera.fov_y *= 0.6;
                            r.size *= 4;
                        },
                    .passes = {"5_refine_pixels"},
                    .resources = {"lists of pixels", "saturated pixels, host", "finest splats of tiles"},
                    .resized = {"tile order", "tile entries"},
                    .constants = {{shader::SPEC_REFINED, "SPEC_REFINED"}},
                    .frame_fields = {"tile_finest"}});
    rows.push_back(
        {.name = "buried voxels",
         .help = "voxels that opaque ones occlude from every side are culled; the picture does not change",
         .call = "settings.cull_buried and an opaque material; not with --keep-buried (on by default)",
         .reason = [](const FrameRequest& r) -> std::string {
             const CollectionPlan plan = planned_collection(drawn_parts(r).back());
             if (!plan.buried) return "";
             return fmt::format("voxels at least {} voxels behind an opaque surface are culled",
                                plan.params.bury_distance);
         },
         .turn_on = [](FrameRequest& r) { r.settings.cull_buried = true; },
         .base = make_opaque,
         .passes = {"1a_mark_buried"},
         .resources = {"buried mask"},
         .resized = {"splat list", "batches of splats", "sheets of splats", "splat order", "prepared splats"},
         .constants = {{shader::SPEC_BURIED, "SPEC_BURIED"}},
         .scene_fields = {"opaque_mask", "bury_distance", "opaque_iso"}});
    return rows;
}

}  // namespace edgesplat

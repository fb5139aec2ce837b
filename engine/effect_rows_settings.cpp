// Effects that the settings call for.
#include <fmt/format.h>

#include <algorithm>

#include "engine/effect_rows.h"
#include "engine/frame_forecast.h"
#include "shaders/shared/limits.h"

namespace edgesplat {
namespace {

void warp(FrameRequest& request) {
    request.settings.edges = EdgeEstimator::March;
    request.settings.footprints = FootprintMode::Procedural;
}

}  // namespace

void make_opaque(FrameRequest& request) {
    const glm::dvec3 spacing = request.volume->geometry.spacing();
    request.scene.materials.back().extinction = 2 / std::min({spacing.x, spacing.y, spacing.z});
}

std::vector<Effect> settings_effects() {
    std::vector<Effect> rows;
    rows.push_back(
        {.name = "edge preservation",
         .help = "kernels are warped at iso-values, so that surfaces stay sharp however near they are looked at",
         .call = "settings.edges and footprints; --edges, --footprints (on by default)",
         .reason = [](const FrameRequest& r) -> std::string {
             const Settings s = drawn_settings(r);
             if (!draws_warped(s)) return "";
             return fmt::format("edges are estimated ({}) and footprints warped ({})", name_of(s.edges),
                                name_of(s.footprints));
         },
         .turn_on = warp,
         .passes = {"1_estimate_edges"},
         .resources = {"edge field"},
         .resized = {"prepared splats"},
         .constants = {{shader::SPEC_ESTIMATOR, "SPEC_ESTIMATOR"},
                       {shader::SPEC_FOOTPRINTS, "SPEC_FOOTPRINTS"},
                       {shader::SPEC_EDGES, "SPEC_EDGES"},
                       {shader::SPEC_SMOOTH, "SPEC_SMOOTH"}},
         .frame_fields = {"footprint", "support_table", "spheroids"}});
    rows.push_back({.name = "spline edges",
                    .help = "edges are found on the cubic B-spline through the samples",
                    .call = "settings.edges = \"cubic\"; --edges cubic",
                    .reason = [](const FrameRequest& r) -> std::string {
                        const Settings s = drawn_settings(r);
                        return draws_warped(s) && s.edges == EdgeEstimator::Cubic ? "edges are estimated by `cubic`"
                                                                                  : "";
                    },
                    .turn_on = [](FrameRequest& r) { r.settings.edges = EdgeEstimator::Cubic; },
                    .base = warp,
                    .resources = {"B-spline coefficients"},
                    .constants = {{shader::SPEC_ESTIMATOR, "SPEC_ESTIMATOR", 3}}});
    rows.push_back({.name = "curved edges",
                    .help = "an edge is a sphere of its curvature, not its tangent plane",
                    .call = "settings.edge_shape = \"curved\"; --edge-shape curved",
                    .reason = [](const FrameRequest& r) -> std::string {
                        const Settings s = drawn_settings(r);
                        return draws_warped(s) && s.edge_shape == EdgeShape::Curved ? "edge_shape is `curved`" : "";
                    },
                    .turn_on = [](FrameRequest& r) { r.settings.edge_shape = EdgeShape::Curved; },
                    .base = warp,
                    .resources = {"splat traits"},
                    .record = {{"curvature", 2}},
                    .constants = {{shader::SPEC_CURVED, "SPEC_CURVED"}, {shader::SPEC_NODES, "SPEC_NODES", 8}},
                    .frame_fields = {"traits", "curvature_unit"},
                    .scene_fields = {"traits", "curvature_unit"}});
    rows.push_back({.name = "faces",
                    .help = "kernels are cut at the surface, a quadric that is found once, and lit where rays meet it",
                    .call = "settings.warp = \"face\"; --warp face",
                    .reason = [](const FrameRequest& r) -> std::string {
                        return draws_faces(drawn_settings(r)) ? "warp is `face`" : "";
                    },
                    .turn_on = [](FrameRequest& r) { r.settings.warp = WarpFamily::Face; },
                    .base = warp,
                    .resources = {"splat traits"},
                    .resized = {"prepared splats", "tile entries", "tile marks"},
                    .record = {{"bending", 8}},
                    .constants = {{shader::SPEC_FACES, "SPEC_FACES"},
                                  {shader::SPEC_WARP, "SPEC_WARP"},
                                  {shader::SPEC_SMOOTH, "SPEC_SMOOTH", 1},
                                  {shader::SPEC_NODES, "SPEC_NODES", 8}},
                    .frame_fields = {"traits"},
                    .scene_fields = {"traits"}});
    rows.push_back({.name = "edge weights",
                    .help = "kernels are weighted by their distance to the edge: what lies on one side has its volume",
                    .call = "settings.normalise = \"edge\"; --normalise edge",
                    .reason = [](const FrameRequest& r) -> std::string {
                        const Settings s = drawn_settings(r);
                        const bool family = draws_warped(s) && s.warp == WarpFamily::Edge;
                        return family && s.normalisation == Normalisation::Edge ? "normalise is `edge`" : "";
                    },
                    .turn_on = [](FrameRequest& r) { r.settings.normalisation = Normalisation::Edge; },
                    .base = warp,
                    .resources = {"splat traits"},
                    .record = {{"weight", 2}},
                    .constants = {{shader::SPEC_WEIGHTED, "SPEC_WEIGHTED"}},
                    .frame_fields = {"traits"},
                    .scene_fields = {"traits", "edge_weights", "contrast"}});
    rows.push_back({.name = "kernel weights",
                    .help = "kernels are weighted so that those around a voxel sum to one",
                    .call = "settings.normalise = \"voxel\"; --normalise voxel",
                    .reason = [](const FrameRequest& r) -> std::string {
                        const Settings s = drawn_settings(r);
                        return draws_warped(s) && s.normalisation == Normalisation::Voxel ? "normalise is `voxel`" : "";
                    },
                    .turn_on = [](FrameRequest& r) { r.settings.normalisation = Normalisation::Voxel; },
                    .base = warp,
                    .resources = {"splat traits"},
                    .record = {{"weight", 2}},
                    .constants = {{shader::SPEC_WEIGHTED, "SPEC_WEIGHTED"}},
                    .frame_fields = {"traits"},
                    .scene_fields = {"traits", "strength"}});
    rows.push_back(
        {.name = "footprint table",
         .help = "footprints are looked up, not integrated",
         .call = "settings.footprints = \"table\" or \"table-lerp\"; --footprints table-lerp",
         .reason = [](const FrameRequest& r) -> std::string {
             const Settings s = drawn_settings(r);
             const bool table = s.footprints == FootprintMode::Table || s.footprints == FootprintMode::TableLerp;
             if (!draws_warped(s) || s.warp != WarpFamily::Edge || !table) return "";
             return fmt::format("footprints are `{}` of size `{}`", name_of(s.footprints), name_of(s.table_size));
         },
         .turn_on = [](FrameRequest& r) { r.settings.footprints = FootprintMode::TableLerp; },
         .base = warp,
         .resources = {"footprint table"},
         .constants = {{shader::SPEC_FOOTPRINTS, "SPEC_FOOTPRINTS", 4}}});
    rows.push_back({.name = "sliced sheets",
                    .help = "kernels are cut at the planes between sheets, so that nothing pops as the eye moves",
                    .call = "settings.sheets = \"sliced\"; --sheets sliced",
                    .reason = [](const FrameRequest& r) -> std::string {
                        if (drawn_settings(r).sheets != SheetCut::Sliced) return "";
                        return fmt::format("sheets are `sliced`, {} voxel apart", r.settings.sheet_spacing);
                    },
                    .turn_on = [](FrameRequest& r) { r.settings.sheets = SheetCut::Sliced; },
                    .resized = {"splat order", "sort counters", "pairs of sheets", "sheet starts", "chunks of sheets",
                                "prepared splats"},
                    .constants = {{shader::SPEC_SLICED, "SPEC_SLICED"}, {shader::SPEC_NODES, "SPEC_NODES", 8}}});
    rows.push_back({.name = "half sheets",
                    .help = "a sheet's colour and depth take half the memory",
                    .call = "settings.sheet_format = \"half\"; --sheet-format half",
                    .reason = [](const FrameRequest& r) -> std::string {
                        return drawn_settings(r).sheet_format == SheetFormat::Half ? "sheet_format is `half`" : "";
                    },
                    .turn_on = [](FrameRequest& r) { r.settings.sheet_format = SheetFormat::Half; },
                    .base = [](FrameRequest& r) { r.settings.sheet_format = SheetFormat::Float; },
                    .resized = {"sheet group"}});
    rows.push_back({.name = "half accumulation",
                    .help = "the picture that sheets are composited into takes half the memory",
                    .call = "settings.accumulation = \"half\"; --accumulation half",
                    .reason = [](const FrameRequest& r) -> std::string {
                        return drawn_settings(r).accumulation == SheetFormat::Half ? "accumulation is `half`" : "";
                    },
                    .turn_on = [](FrameRequest& r) { r.settings.accumulation = SheetFormat::Half; },
                    .base = [](FrameRequest& r) { r.settings.sheet_format = SheetFormat::Float; },
                    .resized = {"accumulated picture"}});
    rows.push_back({.name = "refined pixels",
                    .help = "where the picture is smooth one pixel of four or sixteen is drawn, and the others follow",
                    .call = "settings.pixels = \"refined\"; --pixels refined (on by default)",
                    .reason = [](const FrameRequest& r) -> std::string {
                        const Settings s = drawn_settings(r);
                        const bool refined = s.pixels == PixelChoice::Refined && s.sheet_format == SheetFormat::Tiles;
                        return refined ? "pixels are `refined`" : "";
                    },
                    .turn_on = [](FrameRequest& r) { r.settings.pixels = PixelChoice::Refined; },
                    .base =
                        [](FrameRequest& r) {
                            // Near enough that splats are many pixels wide.
                            r.settings.pixels = PixelChoice::Every;
                            r.camera.fov_y *= 0.6;
                            r.size *= 4;
                        },
                    .passes = {"5_refine_pixels"},
                    .resources = {"lists of pixels", "closed pixels, seen", "finest splats of tiles"},
                    .resized = {"tile order", "tile entries"},
                    .constants = {{shader::SPEC_REFINED, "SPEC_REFINED"}, {shader::SPEC_GROUP, "SPEC_GROUP", 256}},
                    .frame_fields = {"tile_finest"}});
    rows.push_back(
        {.name = "buried voxels",
         .help = "voxels that opaque ones hide from every side are dropped: the picture is the same",
         .call = "settings.cull_buried and an opaque material; not with --keep-buried (on by default)",
         .reason = [](const FrameRequest& r) -> std::string {
             const bool keep = r.outputs.tau || eye_in_opaque(*r.volume, r.scene, r.camera);
             const CollectionPlan plan = plan_collection(*r.volume, r.scene, drawn_settings(r), keep);
             if (!plan.buried) return "";
             return fmt::format("what lies {} voxels behind an opaque surface cannot be seen",
                                plan.params.bury_distance);
         },
         .turn_on = [](FrameRequest& r) { r.settings.cull_buried = true; },
         .base = make_opaque,
         .passes = {"1a_mark_buried"},
         .resources = {"buried mask"},
         .resized = {"splat list", "batches of splats", "sheets of splats", "splat order", "prepared splats"},
         .constants = {{shader::SPEC_BURIED, "SPEC_BURIED"}},
         .scene_fields = {"opaque_mask", "bury_distance"}});
    return rows;
}

}  // namespace edgesplat

// Effects of clipping, sampling, background and overlays.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "engine/forecast/effect_rows.h"
#include "engine/forecast/forecast.h"
#include "shaders/shared/limits.h"

namespace edgesplat {

std::vector<Effect> view_effects() {
    std::vector<Effect> rows;
    rows.push_back(
        {.name = "clip",
         .help = "planes or a box cut matter away sharply; the cut is shaded with the plane's normal",
         .call = "effects.clip.keep, remove; --clip",
         .reason = [](const FrameRequest& r) -> std::string {
             const Clip& clip = r.scene.effects.clip;
             if (clip.empty()) return "";
             return fmt::format("effects.clip has {} planes to keep within, {} to remove within", clip.keep.size(),
                                clip.remove.size());
         },
         .turn_on =
             [](FrameRequest& r) {
                 const VolumeGeometry& g = r.volume->geometry;
                 const glm::dvec3 middle = g.center();
                 r.scene.effects.clip.keep = {{middle, r.camera.eye - middle + glm::dvec3(0, 0, 1e-3)}};
                 r.scene.effects.clip.remove = {{middle, middle - r.camera.eye + glm::dvec3(0, 1e-3, 0)},
                                                {g.to_world(glm::dvec3(g.dims - 1) * 0.25), glm::dvec3(-1, 0, 0)}};
             },
         .base =
             [](FrameRequest& r) {
                 make_opaque(r);
                 r.settings.cull_buried = true;
             },
         .resized = {"splat list", "batches of splats", "sheets of splats", "splat order", "sort counters",
                     "tiles of splats", "pairs of sheets", "sheet starts", "chunks of sheets", "prepared splats"},
         .constants = {{shader::SPEC_CLIP_KEEP, "SPEC_CLIP_KEEP"}, {shader::SPEC_CLIP_REMOVE, "SPEC_CLIP_REMOVE"}},
         .volume_fields = {"clip_keep", "clip_remove"},
         .scene_fields = {"clip_keep", "clip_remove"}});
    rows.push_back({.name = "antialias",
                    .help = "footprints are at least a pixel wide; their integrals do not change",
                    .call = "effects.antialias; --antialias",
                    .reason = [](const FrameRequest& r) -> std::string {
                        return r.scene.effects.antialias ? "effects.antialias is true" : "";
                    },
                    .turn_on = [](FrameRequest& r) { r.scene.effects.antialias = true; },
                    .resized = {"prepared splats"},
                    .constants = {{shader::SPEC_ANTIALIAS, "SPEC_ANTIALIAS"}},
                    .frame_fields = {"pixel"}});
    rows.push_back({.name = "smooth outlines",
                    .help = "a pixel on an outline blends the colours of both sides by the distance to the face",
                    .call = "effects.smooth_outlines; --smooth-outlines",
                    .reason = [](const FrameRequest& r) -> std::string {
                        return smooths_outlines(drawn_settings(r), r.scene) ? "effects.smooth_outlines is true" : "";
                    },
                    .turn_on = [](FrameRequest& r) { r.scene.effects.smooth_outlines = true; },
                    .base = cut_at_faces,
                    .resources = {"outlines"},
                    .constants = {{shader::SPEC_OUTLINES, "SPEC_OUTLINES"}}});
    rows.push_back({.name = "samples",
                    .help = "a pixel is the mean of n x n rays, each from its own picture",
                    .call = "effects.samples; --samples",
                    .reason = [](const FrameRequest& r) -> std::string {
                        const int n = r.scene.effects.samples;
                        return n > 1 ? fmt::format("effects.samples is {}: {} pictures", n, n * n) : "";
                    },
                    .turn_on = [](FrameRequest& r) { r.scene.effects.samples = 2; }});
    rows.push_back({.name = "background of two colours",
                    .help = "the background is a gradient from a colour at the bottom to another at the top",
                    .call = "effects.background_top",
                    .reason = [](const FrameRequest& r) -> std::string {
                        const auto& top = r.scene.effects.background_top;
                        return top ? fmt::format("effects.background_top is {}, {}, {}", top->x, top->y, top->z) : "";
                    },
                    .turn_on = [](FrameRequest& r) { r.scene.effects.background_top = glm::dvec3(0.3, 0.4, 0.6); },
                    .constants = {{shader::SPEC_GRADIENT, "SPEC_GRADIENT"}},
                    .frame_fields = {"background_top"}});
    rows.push_back(
        {.name = "overlays",
         .help = "axes, scale bar and legend, drawn over the picture by the host",
         .call = "effects.overlays.orientation, scale_bar, legend; --overlay",
         .reason = [](const FrameRequest& r) -> std::string {
             const Overlays& o = r.scene.effects.overlays;
             std::vector<std::string_view> on;
             for (const auto& [shown, name] :
                  {std::pair{o.orientation, "orientation"}, {o.scale_bar, "scale_bar"}, {o.legend, "legend"}})
                 if (shown) on.emplace_back(name);
             return on.empty() ? "" : fmt::format("effects.overlays: {}", fmt::join(on, ", "));
         },
         .turn_on =
             [](FrameRequest& r) {
                 r.scene.effects.overlays = {true, true, true};
             }});
    return rows;
}

}  // namespace edgesplat

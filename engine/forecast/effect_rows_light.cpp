// Effects of light and colour, enabled by the scene.
#include <fmt/format.h>

#include <algorithm>

#include "engine/error.h"
#include "engine/forecast/effect_rows.h"
#include "engine/plan/plan.h"
#include "engine/scene/default_materials.h"
#include "engine/store/light.h"
#include "engine/volume/labels.h"
#include "shaders/shared/limits.h"

namespace edgesplat {
namespace {

std::string_view kind_name(Light::Kind kind) {
    switch (kind) {
        case Light::Kind::Directional:
            return "directional";
        case Light::Kind::Point:
            return "a point";
        case Light::Kind::Headlight:
            break;
    }
    return "a headlight";
}

/// Lists the indices of the elements for which `is` is true: "0, 2".
template <typename Elements, typename Is>
std::string numbers(const Elements& elements, const Is& is) {
    std::string text;
    for (std::size_t i = 0; i < elements.size(); ++i)
        if (is(elements[i])) text += fmt::format("{}{}", text.empty() ? "" : ", ", i);
    return text;
}

Light one_light() {
    return directional_light({-1, -1, 1});
}

void light(FrameRequest& request) {
    if (request.scene.lights.empty()) request.scene.lights = {one_light()};
}

void shadow(FrameRequest& request) {
    light(request);
    // A headlight casts no visible shadows.
    Light& first = request.scene.lights[0];
    if (first.kind == Light::Kind::Headlight) first = one_light();
    first.shadows = true;
}

std::string shadow_reason(const FrameRequest& r) {
    const auto numbers = shadow_lights(r.scene);
    if (numbers.empty()) return "";
    return fmt::format("lights[{}]{} cast{} shadows", numbers[0],
                       numbers.size() > 1 ? fmt::format(" and lights[{}]", numbers[1]) : "",
                       numbers.size() > 1 ? "" : "s");
}

std::string occlusion_reason(const FrameRequest& r) {
    if (!occludes_ambient(r.scene)) return "";
    return fmt::format("occlusion has a radius of {:g} mm and strength {:g}", r.scene.effects.occlusion->radius,
                       r.scene.effects.occlusion->strength);
}

/// Extinction at the ramp's low end, relative to its high end.
constexpr double kFaintest = 1e-3;

/// Replaces the materials by a transfer function: a linear ramp up to the highest material's extinction.
void ramp(FrameRequest& request) {
    const auto low = static_cast<double>(request.volume->min_value);
    const auto high = static_cast<double>(request.volume->max_value);
    const Material& material = request.scene.materials.back();
    request.scene.transfer = {{low, material.color, kFaintest * material.extinction},
                              {high, material.color, material.extinction}};
}

/// Gives every material at least the ramp's smallest extinction.
void faint(FrameRequest& request) {
    const double least = kFaintest * request.scene.materials.back().extinction;
    for (Material& material : request.scene.materials)
        material.extinction = std::max(material.extinction, least);
}

/// Makes the volume that of a mask, drawn in one colour.
void mask(FrameRequest& request) {
    const Volume& volume = *request.volume;
    auto made = std::make_shared<Volume>(volume);
    const double iso = request.scene.iso_values.back();
    std::vector<std::uint32_t> labels;
    for (float& sample : made->values) {
        sample = static_cast<double>(sample) >= iso ? 1.0F : 0.0F;
        labels.push_back(sample > 0 ? 1 + static_cast<std::uint32_t>(labels.size() % 2) : 0);
    }
    auto table = std::make_shared<LabelTable>();
    table->labels = {{.id = 1, .value = 1, .name = {}, .color = {}}, {.id = 2, .value = 2, .name = {}, .color = {}}};
    made->labels = std::move(table);
    made->shown_labels = sorted_labels(std::move(labels));
    made->min_value = 0;
    made->max_value = 1;
    request.volume = std::move(made);
    request.scene.iso_values = {0.5};
    request.scene.materials = {request.scene.materials.front(), request.scene.materials.back()};
}

/// Gives the labels their colours.
void label(FrameRequest& request) {
    if (!request.volume->labels) fail("the samples are no labels");
    request.scene.label_colors = label_colors(*request.volume->labels);
}

}  // namespace

std::vector<Effect> light_effects() {
    std::vector<Effect> rows;
    rows.push_back({.name = "light",
                    .help = "surfaces are shaded by their normals",
                    .call = "lights[0]; --light headlight or X,Y,Z (a headlight by default)",
                    .reason = [](const FrameRequest& r) -> std::string {
                        if (r.scene.lights.empty()) return "";
                        return fmt::format("lights[0] is {}", kind_name(r.scene.lights.front().kind));
                    },
                    .turn_on = light,
                    .passes = {"1_estimate_edges"},
                    .resources = {"edge field"},
                    .constants = {{shader::SPEC_LIGHT, "SPEC_LIGHT"}, {shader::SPEC_EDGES, "SPEC_EDGES"}},
                    .frame_fields = {"light_at", "light_color", "ambient"}});
    rows.push_back({.name = "shadows",
                    .help = "matter between a light and a surface darkens the surface",
                    .call = "lights[].shadows",
                    .reason = shadow_reason,
                    .turn_on = shadow,
                    .base = light,
                    .passes = {"2c_cast_shadows"},
                    .resources = {"splat shadows"},
                    .record = {{"light that reaches the splat", 4}},
                    .constants = {{shader::SPEC_SHADOWS, "SPEC_SHADOWS"}},
                    .frame_fields = {"shadow_channels"},
                    .volume_fields = {"splat_shadows"}});
    rows.push_back({.name = "ambient occlusion",
                    .help = "less ambient light reaches hollows",
                    .call = "effects.occlusion",
                    .reason = occlusion_reason,
                    .turn_on = [](FrameRequest& r) { light(r), r.scene.effects.occlusion = AmbientOcclusion{}; },
                    .base = light,
                    .passes = {"2b_occlude_ambient"},
                    .resources = {"splat occlusion"},
                    .record = {{"ambient light that reaches the splat", 4}},
                    .constants = {{shader::SPEC_OCCLUSION, "SPEC_OCCLUSION"}},
                    .frame_fields = {"occlusion_strength"},
                    .volume_fields = {"splat_occlusion"}});
    rows.push_back({.name = "several lights",
                    .help = "up to four lights of three kinds, each with its own colour",
                    .call = "lights[1], lights[2], lights[3]; --light several times",
                    .reason = [](const FrameRequest& r) -> std::string {
                        const std::size_t count = r.scene.lights.size();
                        return count > 1 ? fmt::format("there are {} lights", count) : "";
                    },
                    .turn_on =
                        [](FrameRequest& r) {
                            Light second;
                            second.kind = Light::Kind::Point;
                            second.position = r.camera.eye;
                            second.color = {1, 0.6, 0.4};
                            light(r);
                            r.scene.lights.push_back(second);
                        },
                    .base = light,
                    .constants = {{shader::SPEC_LIGHT, "SPEC_LIGHT", 1}}});
    rows.push_back({.name = "response to light",
                    .help = "materials have their own ambient, diffuse and specular factors",
                    .call = "materials[i].response",
                    .reason = [](const FrameRequest& r) -> std::string {
                        if (r.scene.lights.empty()) return "";
                        const std::string which = numbers(r.scene.materials, [&](const Material& m) {
                            const LightResponse usual;
                            const LightResponse& own = m.response;
                            return (m.extinction > 0 || !r.scene.transfer.empty()) &&
                                   (own.ambient != usual.ambient || own.diffuse != usual.diffuse ||
                                    own.specular != usual.specular);
                        });
                        return which.empty() ? "" : fmt::format("materials {} have their own response", which);
                    },
                    .turn_on = [](FrameRequest& r) { r.scene.materials.back().response.diffuse = 0.7; },
                    .base = light,
                    .constants = {{shader::SPEC_RESPONSE, "SPEC_RESPONSE"}},
                    .volume_fields = {"responses"}});
    rows.push_back({.name = "gloss",
                    .help = "highlights (Blinn-Phong) on glossy materials",
                    .call = "materials[i].response.specular > 0",
                    .reason = [](const FrameRequest& r) -> std::string {
                        if (r.scene.lights.empty()) return "";
                        const std::string which = numbers(r.scene.materials, [&](const Material& m) {
                            return (m.extinction > 0 || !r.scene.transfer.empty()) && m.response.specular > 0;
                        });
                        return which.empty() ? "" : fmt::format("materials {} have a specular response", which);
                    },
                    .turn_on = [](FrameRequest& r) { r.scene.materials.back().response.specular = 0.5; },
                    .base =
                        [](FrameRequest& r) {
                            light(r);
                            r.scene.materials.back().response.diffuse = 0.7;
                        },
                    .constants = {{shader::SPEC_GLOSS, "SPEC_GLOSS"}}});
    rows.push_back({.name = "light on edges only",
                    .help = "splats without an edge are not shaded by their gradient",
                    .call = "lit = \"edges\"",
                    .reason = [](const FrameRequest& r) -> std::string {
                        const bool on = needs_normals(r.scene) && lights_edges_only(r.scene, draws_warped(r.settings));
                        return on ? "lit is `edges`" : "";
                    },
                    .turn_on = [](FrameRequest& r) { r.scene.lit = Lit::Edges; },
                    .base =
                        [](FrameRequest& r) {
                            light(r);
                            r.settings.edges = EdgeEstimator::March;
                            r.settings.footprints = FootprintMode::Procedural;
                        },
                    .constants = {{shader::SPEC_LIT_EDGES, "SPEC_LIT_EDGES"}}});
    rows.push_back({.name = "silhouettes",
                    .help = "surfaces that turn away from the eye get darker or coloured",
                    .call = "effects.silhouette; --silhouette",
                    .reason = [](const FrameRequest& r) -> std::string {
                        const auto& silhouette = r.scene.effects.silhouette;
                        return silhouette ? fmt::format("effects.silhouette has strength {}", silhouette->strength)
                                          : "";
                    },
                    .turn_on = [](FrameRequest& r) { r.scene.effects.silhouette = Silhouette{}; },
                    .passes = {"1_estimate_edges"},
                    .resources = {"edge field"},
                    .constants = {{shader::SPEC_SILHOUETTE, "SPEC_SILHOUETTE"}, {shader::SPEC_EDGES, "SPEC_EDGES"}},
                    .frame_fields = {"silhouette", "silhouette_sharpness"}});
    rows.push_back({.name = "fog",
                    .help = "colours approach the fog's colour with distance",
                    .call = "effects.fog; --fog DENSITY",
                    .reason = [](const FrameRequest& r) -> std::string {
                        const auto& fog = r.scene.effects.fog;
                        return fog ? fmt::format("effects.fog has density {} per mm", fog->density) : "";
                    },
                    .turn_on = [](FrameRequest& r) { r.scene.effects.fog = Fog{}; },
                    .constants = {{shader::SPEC_FOG, "SPEC_FOG"}},
                    .frame_fields = {"fog", "fog_start"}});
    rows.push_back({.name = "transfer function",
                    .help = "colour and extinction are piecewise-linear functions of the value",
                    .call = "transfer, a list of points",
                    .reason = [](const FrameRequest& r) -> std::string {
                        if (r.scene.transfer.empty()) return "";
                        return fmt::format("transfer has {} points", r.scene.transfer.size());
                    },
                    .turn_on = ramp,
                    .base = faint,
                    .resources = {"transfer function", "classified values"},
                    .record = {{"classified value", 4}},
                    .constants = {{shader::SPEC_TRANSFER, "SPEC_TRANSFER"}},
                    .volume_fields = {"transfer", "values"},
                    .scene_fields = {"transfer", "values"}});
    rows.push_back({.name = "labels",
                    .help = "every label of a segmentation has its own colour",
                    .call = "volume.labels, or --labels on",
                    .reason = [](const FrameRequest& r) -> std::string {
                        if (labels_drawn(r.scene, *r.volume) == 0) return "";
                        return fmt::format("the volume has {} labels", r.scene.label_colors.size());
                    },
                    .turn_on = label,
                    .base = mask,
                    .resources = {"labels", "splat labels", "label colours"},
                    .record = {{"label", 4}},
                    .constants = {{shader::SPEC_LABELS, "SPEC_LABELS"}},
                    .frame_fields = {"label_colors"},
                    .volume_fields = {"labels"},
                    .scene_fields = {"labels"}});
    return rows;
}

}  // namespace edgesplat

#include "engine/forecast/effect_table.h"

#include <algorithm>

#include "engine/error.h"
#include "engine/forecast/effect_rows.h"

namespace edgesplat {

std::span<const Effect> effect_table() {
    static const std::vector<Effect> rows = [] {
        std::vector<Effect> all;
        for (auto&& some : {settings_effects(), light_effects(), view_effects(), output_effects()})
            all.insert(all.end(), some.begin(), some.end());
        return all;
    }();
    return rows;
}

const Effect& effect_named(std::string_view name) {
    std::string known;
    for (const Effect& effect : effect_table()) {
        if (effect.name == name) return effect;
        known += (known.empty() ? "" : ", ") + std::string(effect.name);
    }
    fail("unknown effect '{}', expected one of: {}", name, known);
}

FrameRequest plain_request(FrameRequest request) {
    Scene& scene = request.scene;
    scene.lights.clear();
    scene.lit = Lit::Everywhere;
    scene.effects = {};
    if (scene.iso_values.empty()) {
        const double low = request.volume->min_value, high = request.volume->max_value;
        scene.iso_values = {(low + high) / 2};
        scene.materials = {{}, {.extinction = 1}};
    }
    scene.transfer.clear();
    scene.label_colors.clear();
    for (Material& material : scene.materials)
        material.response = {};
    Settings plain;
    plain.edges = EdgeEstimator::Off;
    plain.footprints = FootprintMode::Isotropic;
    plain.cull_buried = false;
    plain.opaque = OpaqueMatter::Kernels;
    plain.pixels = PixelChoice::Every;
    plain.sheet_spacing = request.settings.sheet_spacing;
    plain.saturation = request.settings.saturation;
    request.settings = plain;
    request.outputs = {};
    return request;
}

}  // namespace edgesplat

#include <algorithm>

#include "engine/error.h"
#include "engine/plan/resource_table.h"
#include "engine/renderer/state.h"
#include "engine/store/light.h"
#include "footprints/kernel.h"

namespace edgesplat {
namespace {

// The layers are indexed by a signed 32-bit number.
constexpr std::uint64_t kMostLayerBytes = std::uint64_t{1} << 33U;

}  // namespace

bool RendererState::occlude(const Scene& scene) {
    if (!occludes_ambient(scene)) {
        volume_resources.occlusion = {};
        occluded.reset();
        return false;
    }
    const OcclusionPlan wanted = plan_occlusion(scene);
    if (occluded == wanted) return false;
    occluded.reset();
    volume_resources.occlusion = {};
    bindings.write(volume_resources, {});
    add_times(collection_times, run_occlusion(device, commands, bindings, *volume, wanted, volume_resources));
    occluded = wanted;
    return true;
}

bool RendererState::cast_shadows(const Scene& scene, const Settings& settings) {
    if (shadow_lights(scene).empty()) {
        volume_resources.shadows = {};
        shadowed.reset();
        return false;
    }
    const ShadowPlan wanted = plan_shadows(scene, settings);
    if (shadowed == wanted) return false;
    shadowed.reset();
    drop_targets();
    volume_resources.shadows = {};
    volume_resources.shadows = gpu::Buffer(device, volume_resources.splat_count * kLightBytes,
                                           gpu::Buffer::Place::Device, "splat shadows");
    // What lies in no picture of the light is in nothing's shadow.
    commands.run([&] { commands.fill(volume_resources.shadows, ~0U); });

    const auto& resources = volume_resources;
    const double reach = kernel_reach(settings);
    for (std::uint32_t channel = 0; channel < wanted.lights.size(); ++channel) {
        for (const Camera& view : light_views(wanted.lights[channel], volume->geometry, resources.box_low,
                                              resources.box_high, reach, wanted.quality.resolution)) {
            FramePlan light = plan_light_frame(*volume, scene, wanted, view, resources, reach);
            if (light_layer_bytes(light) > kMostLayerBytes) {
                fail(
                    "shadows: {} x {} pixels of {} layers take {} MiB; {} are possible: choose a smaller resolution "
                    "or fewer layers",
                    light.params.size.x, light.params.size.y, light.params.sheet_count, light_layer_bytes(light) >> 20U,
                    kMostLayerBytes >> 20U);
            }
            const gpu::Buffer layers(device, light_layer_bytes(light), gpu::Buffer::Place::Device, kLightLayers.name);
            light.params.light_layers = layers.address();
            provide_targets(light);
            add_times(collection_times, draw_sheets(commands, light, targets, channel));
        }
    }
    drop_targets();
    shadowed = wanted;
    return true;
}

void RendererState::drop_targets() {
    TargetResources kept;
    for (const TargetBufferRow& row : target_buffer_rows())
        if (row.always) kept.*row.buffer = std::move(targets.*row.buffer);
    targets = std::move(kept);
}

}  // namespace edgesplat

#include "engine/frame/setup.h"

#include "engine/clock.h"
#include "engine/error.h"
#include "engine/frame/frame.h"
#include "footprints/kernel.h"

namespace edgesplat {
namespace {

// The layers are indexed by a signed 32-bit number.
constexpr std::uint64_t kMostLayerBytes = std::uint64_t{1} << 33U;

}  // namespace

double set_up(DeviceSession& session, LevelStore& level, Targets& targets, const Scene& scene, const Settings& settings,
              bool keep_buried, SetupCost& cost) {
    const auto start = Clock::now();
    const bool uploaded = level.volume.provide();
    const CollectionPlan wanted = plan_collection(*level.volume.volume(), scene, settings, keep_buried);
    const bool collected = level.splats.collect(level.volume, wanted, cost);
    const bool occluded = level.splats.occlude(level.volume, scene, cost);
    const bool shadowed = cast_shadows(session, level, targets, scene, settings, cost);
    return uploaded || collected || occluded || shadowed ? milliseconds_since(start) : 0;
}

bool cast_shadows(DeviceSession& session, LevelStore& level, Targets& targets, const Scene& scene,
                  const Settings& settings, SetupCost& cost) {
    SplatStore& splats = level.splats;
    if (shadow_lights(scene).empty()) {
        splats.drop_shadows();
        return false;
    }
    const ShadowPlan wanted = plan_shadows(scene, settings);
    if (splats.shadowed() == wanted) return false;
    targets.drop();
    splats.begin_shadows();
    const Volume& volume = *level.volume.volume();
    const SplatExtent extent = splats.lists().extent();
    const double reach = kernel_reach(settings);
    for (std::uint32_t channel = 0; channel < wanted.lights.size(); ++channel) {
        for (const Camera& view : light_views(wanted.lights[channel], volume.geometry, extent.low, extent.high, reach,
                                              wanted.quality.resolution)) {
            FramePlan light = plan_light_frame(volume, scene, wanted, view, extent, reach);
            if (light_layer_bytes(light) > kMostLayerBytes) {
                fail(
                    "shadows: {} x {} pixels of {} layers take {} MiB; {} are possible: choose a smaller resolution "
                    "or fewer layers",
                    light.params.size.x, light.params.size.y, light.params.sheet_count, light_layer_bytes(light) >> 20U,
                    kMostLayerBytes >> 20U);
            }
            const gpu::Buffer layers(session.device(), light_layer_bytes(light), gpu::Buffer::Place::Device,
                                     kLightLayers.name);
            light.params.light_layers = layers.address();
            targets.provide(light, splats.lists());
            add_times(cost.times, draw_sheets(session.commands(), light, targets.resources(), channel));
        }
    }
    targets.drop();
    splats.end_shadows(wanted);
    return true;
}

}  // namespace edgesplat

// PictureDrawer: draws the pictures of shadow-casting lights, passes 2c and 2d.
#include "engine/error.h"
#include "engine/frame/picture.h"
#include "footprints/kernel.h"

namespace edgesplat {
namespace {

// Shaders index the layers' floats by a signed 32-bit number.
constexpr std::uint64_t kMostLayerBytes = std::uint64_t{1} << 33U;

}  // namespace

bool PictureDrawer::cast_shadows(LevelStore& level, const Scene& scene, const Settings& settings, SetupCost& cost) {
    SplatStore& splats = level.splats;
    const ShadowPlan wanted = plan_shadows(scene, settings);
    if (splats.shadowed() == wanted) return false;
    targets_.drop();
    splats.begin_shadows();
    splats.bind(level.volume);
    const Volume& volume = *level.volume.volume();
    const SplatExtent extent = splats.lists().extent();
    const double reach = kernel_reach(settings);
    for (std::uint32_t channel = 0; channel < wanted.lights.size(); ++channel) {
        for (const Camera& view : light_views(wanted.lights[channel], volume.geometry, extent.low, extent.high, reach,
                                              wanted.quality.resolution)) {
            FramePlan light = plan_light_frame(volume, scene, wanted, view, extent, reach);
            if (light_layer_bytes(light) > kMostLayerBytes) {
                fail(
                    "shadows: {} x {} pixels of {} layers take {} MiB; at most {} MiB are possible: choose a smaller "
                    "resolution or fewer layers",
                    light.params.size.x, light.params.size.y, light.params.sheet_count, light_layer_bytes(light) >> 20U,
                    kMostLayerBytes >> 20U);
            }
            const gpu::Buffer layers(session_->device(), light_layer_bytes(light), gpu::Buffer::Place::Device,
                                     kLightLayers.name);
            light.params.light_layers = layers.address();
            targets_.provide(light, splats.lists());
            add_times(cost.times, draw_sheets(session_->commands(), light, targets_.resources(), channel));
        }
    }
    targets_.drop();
    splats.end_shadows(wanted);
    return true;
}

}  // namespace edgesplat

// Renderer::raycast: draws a scene by ray casting.
#include "engine/clock.h"
#include "engine/error.h"
#include "engine/overlays/overlays.h"
#include "engine/renderer/state.h"

namespace edgesplat {

void validate(const RaycastSettings& settings) {
    // Written so that NaN fails it.
    if (!(settings.step > 0.01 && settings.step <= 4))
        fail("raycast step: {} is outside (0.01, 4] voxels", settings.step);
}

RenderResult Renderer::raycast(const Scene& scene, const Camera& camera, const Settings& wanted,
                               const RaycastSettings& raycast, int width, int height) {
    if (!state_->splats.original()) fail("raycast: no volume has been set");
    if (width < 1 || height < 1 || width > 16384 || height > 16384)
        fail("size: {}x{}, expected 1 to 16384 pixels per side", width, height);
    validate(scene);
    if (const std::string beyond = raycast_obstacle(scene); !beyond.empty())
        fail("raycast: {} is not supported, expected a scene without it", beyond);
    validate(wanted);
    validate(raycast);
    return draw_again_if_lost([&] { return raycast_once(scene, camera, wanted, raycast, width, height); });
}

RenderResult Renderer::raycast_once(const Scene& scene, const Camera& camera, const Settings& wanted,
                                    const RaycastSettings& raycast, int width, int height) {
    RendererState& self = *state_;
    gpu::Commands& commands = self.session.commands();
    const gpu::Device& device = self.session.device();
    const Settings settings = canonical_settings(wanted);
    RenderResult result;
    auto& stats = result.stats;
    const std::uint64_t submissions_before = commands.submissions();
    auto start = Clock::now();
    if (self.splats.provide_volume(raycast.filter == RaycastFilter::Cubic))
        stats.setup_milliseconds += milliseconds_since(start);
    if (labels_drawn(scene, *self.splats.original()) != 0 && self.splats.provide_labels())
        stats.setup_milliseconds += milliseconds_since(start);
    const VolumeStore& store = self.splats.level().volume;
    const Volume& volume = *store.volume();
    if (raycast.filter == RaycastFilter::Cubic && !scene.transfer.empty() && volume.no_data)
        fail(
            "raycast: {}: the cubic filter reaches into samples without data, expected the trilinear one "
            "(--raycast-filter trilinear)",
            volume.name);
    start = Clock::now();
    if (!self.rays) self.rays.emplace(device, self.session.pipelines(), commands);
    const auto plan = plan_raycast(volume, scene, camera, settings, raycast,
                                   plan_collection(volume, scene, settings, true), {width, height});
    self.rays->prepare(device, plan, store.images());
    if (self.rays->classify(device, commands, plan)) {
        stats.setup_milliseconds += milliseconds_since(start);
        add_times(stats.passes, commands.span_times());
    }
    start = Clock::now();
    self.rays->cast(commands, plan);
    stats.frame_milliseconds = milliseconds_since(start);
    add_times(stats.passes, commands.span_times());
    result.color = Image(width, height, 4);
    std::ranges::copy(self.rays->pixels(), result.color.pixels.begin());
    if (scene.effects.overlays.any()) draw_overlays(result.color, volume, scene, camera);
    stats.submissions = commands.submissions() - submissions_before;
    stats.device = device.info();
    stats.voxels = volume.geometry.voxel_count();
    stats.device_bytes = device.allocated_bytes();
    stats.validation_messages = validation_messages();
    return result;
}

}  // namespace edgesplat

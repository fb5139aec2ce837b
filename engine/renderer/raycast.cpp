// Renderer::raycast: the other way to look at the same scene.
#include <chrono>

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
    if (!state_->original) fail("raycast: no volume has been set");
    if (width < 1 || height < 1 || width > 16384 || height > 16384)
        fail("size: {}x{}, expected 1 to 16384 pixels per side", width, height);
    validate(scene);
    if (const std::string beyond = beyond_ray_casting(scene); !beyond.empty())
        fail("raycast: {} cannot be shown, expected a scene without", beyond);
    validate(wanted);
    validate(raycast);
    return draw_again_if_lost([&] { return raycast_once(scene, camera, wanted, raycast, width, height); });
}

RenderResult Renderer::raycast_once(const Scene& scene, const Camera& camera, const Settings& wanted,
                                    const RaycastSettings& raycast, int width, int height) {
    auto& self = *state_;
    const Settings settings = drawn_as(wanted);
    RenderResult result;
    auto& stats = result.stats;
    const std::uint64_t submissions_before = self.commands.submissions();
    self.show_whole();
    self.provide_volume();
    const auto add_times = [&](const std::vector<PassTime>& times) {
        stats.passes.insert(stats.passes.end(), times.begin(), times.end());
    };
    auto start = Clock::now();
    if (raycast.filter == RaycastFilter::Cubic && self.provide_coefficients())
        stats.setup_milliseconds += milliseconds_since(start);
    start = Clock::now();
    if (!self.raycast) self.raycast.emplace(self.device, self.pipelines, self.commands);
    auto& rays = *self.raycast;
    const auto plan = plan_raycast(*self.volume, scene, camera, settings, raycast,
                                   plan_collection(*self.volume, scene, settings, true), {width, height});
    rays.prepare(self.device, plan, self.volume_resources);
    if (rays.classify(self.device, self.commands, plan)) {
        stats.setup_milliseconds += milliseconds_since(start);
        add_times(self.commands.span_times());
    }
    start = Clock::now();
    rays.cast(self.commands, plan);
    stats.frame_milliseconds = milliseconds_since(start);
    add_times(self.commands.span_times());
    result.color = Image(width, height, 4);
    std::ranges::copy(self.raycast->pixels(), result.color.pixels.begin());
    if (scene.effects.overlays.any()) draw_overlays(result.color, *self.volume, scene, camera);
    stats.submissions = self.commands.submissions() - submissions_before;
    stats.device = self.device.info();
    stats.voxels = self.volume->geometry.voxel_count();
    stats.device_bytes = self.device.allocated_bytes();
    stats.validation_messages = validation_messages();
    return result;
}

}  // namespace edgesplat

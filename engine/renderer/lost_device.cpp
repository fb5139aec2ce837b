// Renderer: recovers from a lost device, once per picture.
#include <utility>

#include "engine/error.h"
#include "engine/renderer/state.h"

namespace edgesplat {
namespace {

[[noreturn]] void give_up(const std::string& device) {
    throw DeviceLost(
        fmt::format("Vulkan: the device{} was lost (ErrorDeviceLost), and again after it was reopened; a driver stops "
                    "work that takes too long or fails: see the system's log, try a smaller --size or another --device",
                    device.empty() ? "" : " " + device));
}

}  // namespace

std::unique_ptr<RendererState> open_state(const DeviceChoice& choice, int attempts, std::uint64_t messages_before) {
    for (;;) {
        try {
            return std::make_unique<RendererState>(choice, messages_before);
        } catch (const vk::DeviceLostError&) {
            if (--attempts <= 0) give_up(choice.device);
        } catch (const vk::SystemError& error) {
            fail("Vulkan: {}", error.what());
        }
    }
}

void Renderer::simulate_device_loss() {
    state_->lose = true;
}

RenderResult Renderer::draw_again_if_lost(const std::function<RenderResult()>& draw) {
    for (bool again = false;; again = true) {
        try {
            if (std::exchange(state_->lose, false)) throw vk::DeviceLostError("simulated");
            return draw();
        } catch (const vk::DeviceLostError&) {
            // The other parts of a divided picture have continued and cannot repeat it.
            if (again) give_up(device().name);
        } catch (const vk::SystemError& error) {
            fail("Vulkan: {}", error.what());
        }
        fmt::print(stderr, "edgesplat: warning: the device {} was lost; it is reopened and the picture drawn again\n",
                   device().name);
        // Options and volume are carried over to the new device.
        auto fresh = open_state(state_->session.choice(), 1, validation_messages());
        fresh->options = state_->options;
        fresh->session.commands().count_draws(fresh->options.counting);
        fresh->splats.set_volume(state_->splats.original());
        state_ = std::move(fresh);
    }
}

}  // namespace edgesplat

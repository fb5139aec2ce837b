// A device that is lost: opened anew, once a picture.
#include <utility>

#include "engine/error.h"
#include "engine/renderer/state.h"

namespace edgesplat {
namespace {

[[noreturn]] void give_up(const std::string& device) {
    throw DeviceLost(
        fmt::format("Vulkan: the device{} was lost (ErrorDeviceLost), and again after it was opened anew; its driver "
                    "ends what takes too long or fails: try a smaller --size or another --device, see the system's log",
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

void Renderer::lose_device() {
    state_->lose = true;
}

RenderResult Renderer::draw_again_if_lost(const std::function<RenderResult()>& draw) {
    for (bool again = false;; again = true) {
        try {
            if (std::exchange(state_->lose, false)) throw vk::DeviceLostError("as it was asked for");
            return draw();
        } catch (const vk::DeviceLostError&) {
            // Of a picture in parts the others have gone on.
            if (again || state_->orders.exchange != nullptr) give_up(device().name);
        } catch (const vk::SystemError& error) {
            fail("Vulkan: {}", error.what());
        }
        fmt::print(stderr, "edgesplat: warning: the device {} was lost; it is opened anew and the picture made again\n",
                   device().name);
        // What was asked of it is asked of the new one.
        auto fresh = open_state(state_->session.choice(), 1, validation_messages());
        fresh->orders = state_->orders;
        fresh->session.commands().count_draws(fresh->orders.counting);
        fresh->splats.set_volume(state_->splats.original());
        state_ = std::move(fresh);
    }
}

}  // namespace edgesplat

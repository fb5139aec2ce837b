// A device that is lost: opened anew, once a picture.
#include <utility>

#include "engine/error.h"
#include "engine/renderer/state.h"

namespace edgesplat {
namespace {

/// What was asked of `lost`, asked of `fresh`.
void take_over(RendererState& fresh, const RendererState& lost) {
    fresh.patience = lost.patience;
    fresh.interruption = lost.interruption;
    fresh.memory_budget = lost.memory_budget;
    fresh.counting = lost.counting;
    fresh.commands.count_draws(lost.counting);
    fresh.messages_before = lost.messages_before + lost.device.validation_messages();
    fresh.original = lost.original;
    if (fresh.original) fresh.use_level(0);
}

[[noreturn]] void give_up(const std::string& device) {
    throw DeviceLost(
        fmt::format("Vulkan: the device{} was lost (ErrorDeviceLost), and again after it was opened anew; its driver "
                    "ends what takes too long or fails: try a smaller --size or another --device, see the system's log",
                    device.empty() ? "" : " " + device));
}

}  // namespace

std::unique_ptr<RendererState> open_state(const DeviceChoice& choice, int attempts) {
    for (;;) {
        try {
            return std::make_unique<RendererState>(choice);
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
            if (again || state_->exchange != nullptr) give_up(device().name);
        } catch (const vk::SystemError& error) {
            fail("Vulkan: {}", error.what());
        }
        fmt::print(stderr, "edgesplat: warning: the device {} was lost; it is opened anew and the picture made again\n",
                   device().name);
        auto fresh = open_state(state_->opened_as, 1);
        take_over(*fresh, *state_);
        state_ = std::move(fresh);
    }
}

}  // namespace edgesplat

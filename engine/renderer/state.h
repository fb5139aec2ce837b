// What a Renderer owns, one owner for each lifetime.
#pragma once

#include "engine/renderer/splat_provider.h"

namespace edgesplat {

struct RendererState {
    explicit RendererState(const DeviceChoice& choice, std::uint64_t messages_before = 0)
        : session(choice, messages_before) {
        orders.check_numbers = choice.check_numbers;
    }

    Orders orders;
    DeviceSession session;
    PictureDrawer drawer{session, orders};
    std::optional<RaycastResources> rays;  ///< of the volume, once a picture was made that way
    SplatProvider splats{session, orders, drawer, rays};
    bool lose = false;  ///< see Renderer::lose_device
};

/// Opens the device; where it is lost meanwhile, up to so many times. Throws Error, DeviceLost in the end.
std::unique_ptr<RendererState> open_state(const DeviceChoice& choice, int attempts, std::uint64_t messages_before = 0);

}  // namespace edgesplat

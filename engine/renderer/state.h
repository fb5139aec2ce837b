// The state of a Renderer: one owner for each lifetime.
#pragma once

#include "engine/renderer/splat_provider.h"
#include "footprints/cache_folder.h"

namespace edgesplat {

struct RendererState {
    explicit RendererState(const DeviceChoice& choice, std::uint64_t messages_before = 0)
        : session(choice, messages_before) {
        options.check_numbers = choice.check_numbers;
        if (choice.keep_splats && !cache_folder().empty()) options.kept_splats = cache_folder() / "splats";
    }

    RenderOptions options;
    DeviceSession session;
    PictureDrawer drawer{session, options};
    std::optional<RaycastResources> rays;  ///< of the volume; set after the first ray-cast picture
    SplatProvider splats{session, options, drawer, rays};
    bool lose = false;  ///< the next picture fails once: Renderer::simulate_device_loss
};

/// Opens the device; if it is lost meanwhile, tries up to `attempts` times. Throws Error, or DeviceLost after the last
/// attempt.
std::unique_ptr<RendererState> open_state(const DeviceChoice& choice, int attempts, std::uint64_t messages_before = 0);

}  // namespace edgesplat

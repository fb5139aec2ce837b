// The single Renderer of a program, with validation and synchronization validation, and one-call rendering.
#pragma once

#include <cstdlib>
#include <memory>
#include <string>

#include "engine/renderer.h"

namespace edgesplat::test {

inline std::unique_ptr<Renderer>& held_renderer() {
    static std::unique_ptr<Renderer> renderer;
    return renderer;
}

/// Call before main ends: later, the validation layer's static data is already destroyed.
inline void close_test_renderer() {
    held_renderer().reset();
}

/// The renderer, opened at the first call. EDGESPLAT_TEST_DEVICE selects the device; "gpu" or unset: the first usable
/// one (with "gpu", `./dev test` leaves the choice of the driver to the machine).
inline Renderer& test_renderer() {
    auto& renderer = held_renderer();
    if (renderer == nullptr) {
        const char* wanted = std::getenv("EDGESPLAT_TEST_DEVICE");
        const std::string device = wanted == nullptr ? "" : wanted;
        renderer =
            std::make_unique<Renderer>(DeviceChoice{.device = device == "gpu" ? "" : device, .validation = true});
    }
    return *renderer;
}

/// Whether the device interpolates pixels (PixelChoice::Refined).
bool refines_pixels();

using VolumePointer = std::shared_ptr<const Volume>;

/// Scene, camera and settings of a picture. The renderer keeps the volume between shots of the same one.
struct Shot {
    VolumePointer volume;
    Scene scene;
    Camera camera;
    Settings settings;
    int width = 64, height = 64;
};

inline RenderResult render(const Shot& shot, const AovRequest& aovs = {}) {
    static VolumePointer current;
    if (current != shot.volume) {
        test_renderer().set_volume(shot.volume);
        current = shot.volume;
    }
    return test_renderer().render(shot.scene, shot.camera, shot.settings, shot.width, shot.height, aovs);
}

inline Image render_tau(const Shot& shot) {
    return *render(shot, {.tau = true}).tau;
}

}  // namespace edgesplat::test

// The one Renderer of a program, with validation and synchronization validation on, and pictures of it in one call.
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

/// To be called before main ends: the validation layer's own statics are gone when ours would be destroyed.
inline void close_test_renderer() {
    held_renderer().reset();
}

/// EDGESPLAT_TEST_DEVICE chooses another device than the first usable one; "gpu" is the first usable one, too (`./dev
/// test` then leaves the choice of the driver to the machine). Opened when first asked for.
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

/// Whether pixels may follow from those around them (PixelChoice::Refined).
bool refines_pixels();

using VolumePointer = std::shared_ptr<const Volume>;

/// What is in the picture and how it is made; the renderer keeps the volume between shots of the same one.
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

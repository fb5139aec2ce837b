// The complete input of a picture.
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <optional>

#include "engine/scene/aov.h"
#include "engine/scene/camera.h"
#include "engine/scene/scene.h"
#include "engine/scene/settings.h"
#include "engine/volume/volume.h"

namespace edgesplat {

/// The complete input of a picture.
struct FrameRequest {
    std::shared_ptr<const Volume> volume;
    Scene scene;
    Camera camera;
    Settings settings;
    glm::ivec2 size{512};
    AovRequest outputs;
    /// All matter, if the request is of the translucent part of a mixture. Rays end at the opaque one.
    std::optional<Scene> whole{};
    std::size_t number = 0;  ///< of its volume (scene_of_volume), if the request is of one of several
    bool mixed = false;      ///< the request is of a part of a mixture
};

}  // namespace edgesplat

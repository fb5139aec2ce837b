// All that decides a picture.
#pragma once

#include <glm/glm.hpp>
#include <memory>

#include "engine/scene/camera.h"
#include "engine/scene/scene.h"
#include "engine/scene/settings.h"
#include "engine/volume/volume.h"

namespace edgesplat {

/// Extra outputs of a frame. Each costs another draw of the splats; none is made unless asked for.
struct AovRequest {
    bool tau = false;       ///< optical depth along the pixel's ray, 1 channel, unsaturated, nothing buried dropped
    bool depth = false;     ///< mean distance along the view axis, mm, 1 channel; 0 where nothing is hit
    bool normal = false;    ///< mean world normal of what is seen, 3 channels, unit length or 0
    bool distance = false;  ///< mean signed distance of the seen voxels to their edge, voxels, 1 channel
};

/// All that decides a picture.
struct FrameRequest {
    std::shared_ptr<const Volume> volume;
    Scene scene;
    Camera camera;
    Settings settings;
    glm::ivec2 size{512};
    AovRequest outputs;
};

}  // namespace edgesplat

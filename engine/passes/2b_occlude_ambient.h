// Splat list and volume -> share of the ambient light that reaches each splat.
#pragma once

#include "engine/gpu/commands.h"
#include "engine/passes/clip_count.h"
#include "shaders/shared/light_params.h"

namespace edgesplat::passes {

/// Inputs of 2b_occlude_ambient and 2c_cast_shadows.
struct SplatLight {
    std::uint64_t splat_count = 0;
    std::uint32_t iso_count = 1;
    ClipCount clip{};
    bool surfaces = false;  ///< surface splats
    bool transfer = false;  ///< extinction is from a transfer function
    bool beside = false;    ///< the matter is that of another volume, and its share multiplies the one that is there
};

/// Specialization of both.
gpu::Specialization light_constants(const SplatLight& in);

/// Reads the matter's volume, SceneParams and the splat list, writes LightParams::reach. View-independent.
gpu::Pass occlude_ambient(const SplatLight& in);

}  // namespace edgesplat::passes

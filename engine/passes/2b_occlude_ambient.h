// Splat list and volume -> how much of the ambient light reaches each splat.
#pragma once

#include "engine/gpu/commands.h"
#include "shaders/shared/occlusion_params.h"

namespace edgesplat::passes {

struct OccludeAmbient {
    shader::Address params;  ///< OcclusionParams
    std::uint64_t splat_count = 0;
    std::uint32_t clip_keep = 0, clip_remove = 0;  ///< planes
    bool transfer = false;                         ///< extinction by SceneParams::transfer
};

/// Reads the volume, SceneParams and the splat list, writes OcclusionParams::reach. View-independent.
void occlude_ambient(gpu::Commands& commands, const OccludeAmbient& in);

}  // namespace edgesplat::passes

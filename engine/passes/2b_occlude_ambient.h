// Splat list and volume -> share of the ambient light that reaches each splat.
#pragma once

#include "engine/gpu/commands.h"
#include "engine/passes/clip_count.h"
#include "shaders/shared/occlusion_params.h"

namespace edgesplat::passes {

struct OccludeAmbient {
    std::uint64_t splat_count = 0;
    std::uint32_t iso_count = 1;
    ClipCount clip{};
    bool surfaces = false;  ///< surface splats
    bool transfer = false;  ///< extinction is from SceneParams::transfer
};

/// Specialization of 2b_occlude_ambient.comp.
gpu::Specialization occlude_constants(const OccludeAmbient& in);

/// Reads the volume, SceneParams and the splat list, writes OcclusionParams::reach. View-independent.
void occlude_ambient(gpu::Commands& commands, const OccludeAmbient& in);

}  // namespace edgesplat::passes

// Surfaces of several volumes -> the first two on each ray.
#pragma once

#include "engine/gpu/commands.h"

namespace edgesplat::passes {

/// What 6_merge_surfaces does with the surfaces of the volume that FrameParams describes, `seen_surfaces`, and those of
/// all volumes so far, `nearest_surfaces`.
enum class Merge : std::uint32_t {
    Begin,  ///< seen -> nearest
    Add,    ///< both -> nearest
    Take    ///< nearest -> seen
};

gpu::Pass merge_surfaces(Merge how, const glm::ivec2& size);

}  // namespace edgesplat::passes

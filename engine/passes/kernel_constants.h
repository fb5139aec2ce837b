// Specialization of the passes that place kernels: which kernels there are, and what cuts them.
#pragma once

#include "engine/passes/5_draw_splats.h"

namespace edgesplat::passes {

inline gpu::Specialization kernel_constants(const DrawVariant& variant) {
    return {{shader::SPEC_FOOTPRINTS, static_cast<std::uint32_t>(variant.footprints)},
            {shader::SPEC_WARP, static_cast<std::uint32_t>(variant.warp)},
            {shader::SPEC_NARROW, variant.narrow ? 1U : 0U},
            {shader::SPEC_SLICED, variant.sliced ? 1U : 0U},
            {shader::SPEC_CLIP_KEEP, variant.clip.keep},
            {shader::SPEC_CLIP_REMOVE, variant.clip.remove},
            {shader::SPEC_ANTIALIAS, variant.antialias ? 1U : 0U},
            {shader::SPEC_CREASES, variant.creases ? 1U : 0U},
            {shader::SPEC_TRACED, variant.traced ? 1U : 0U},
            {shader::SPEC_SURFACES, variant.surfaces ? 1U : 0U},
            {shader::SPEC_TOGETHER, variant.together ? 1U : 0U},
            {shader::SPEC_RIM, variant.rim ? 1U : 0U}};
}

}  // namespace edgesplat::passes

#include "engine/passes/2b_occlude_ambient.h"

namespace edgesplat::passes {

gpu::Specialization occlude_constants(const ClipCount& clip, bool transfer) {
    return {{shader::SPEC_CLIP_KEEP, clip.keep},
            {shader::SPEC_CLIP_REMOVE, clip.remove},
            {shader::SPEC_TRANSFER, transfer ? 1U : 0U}};
}

void occlude_ambient(gpu::Commands& commands, const OccludeAmbient& in) {
    commands.dispatch("2b_occlude_ambient.comp", occlude_constants(in.clip, in.transfer), 0,
                      gpu::groups_for(in.splat_count, 64));
    commands.barrier();
}

}  // namespace edgesplat::passes

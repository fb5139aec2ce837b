#include "engine/passes/2b_occlude_ambient.h"

namespace edgesplat::passes {

void occlude_ambient(gpu::Commands& commands, const OccludeAmbient& in) {
    commands.dispatch("2b_occlude_ambient.comp",
                      {{shader::SPEC_CLIP_KEEP, in.clip_keep},
                       {shader::SPEC_CLIP_REMOVE, in.clip_remove},
                       {shader::SPEC_TRANSFER, in.transfer ? 1U : 0U}},
                      {in.params, 0, 0}, gpu::groups_for(in.splat_count, 64));
    commands.barrier();
}

}  // namespace edgesplat::passes

#include "engine/passes/3_select_footprints.h"

namespace edgesplat::passes {

void select_footprints(gpu::Commands& commands, shader::Address frame, std::uint64_t splat_count, bool sliced,
                       const ClipCount& clip) {
    const gpu::Specialization constants{{shader::SPEC_SLICED, sliced ? 1U : 0U},
                                        {shader::SPEC_CLIP_KEEP, clip.keep},
                                        {shader::SPEC_CLIP_REMOVE, clip.remove}};
    commands.dispatch("3_select_footprints.comp", constants, {frame, 0, 0}, gpu::groups_for(splat_count, 64));
    commands.barrier();
}

}  // namespace edgesplat::passes

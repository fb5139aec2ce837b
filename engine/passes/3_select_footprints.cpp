#include "engine/passes/3_select_footprints.h"

namespace edgesplat::passes {

void select_footprints(gpu::Commands& commands, shader::Address frame, std::uint64_t splat_count, bool sliced) {
    commands.dispatch("3_select_footprints.comp", {{shader::SPEC_SLICED, sliced ? 1U : 0U}}, {frame, 0, 0},
                      gpu::groups_for(splat_count, 64));
    commands.barrier();
}

}  // namespace edgesplat::passes

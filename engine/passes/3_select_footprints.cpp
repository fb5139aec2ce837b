#include "engine/passes/3_select_footprints.h"

namespace edgesplat::passes {

void select_footprints(gpu::Commands& commands, shader::Address frame, std::uint64_t splat_count) {
    commands.dispatch("3_select_footprints.comp", {}, {frame, 0, 0}, gpu::groups_for(splat_count, 64));
    commands.barrier();
}

}  // namespace edgesplat::passes

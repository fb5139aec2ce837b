#include "engine/passes/2c_cast_shadows.h"

namespace edgesplat::passes {

void cast_shadows(gpu::Commands& commands, const SplatLight& in) {
    commands.dispatch("2c_cast_shadows.comp", light_constants(in), 0, commands.groups_for(in.splat_count, 64));
    commands.barrier();
}

}  // namespace edgesplat::passes

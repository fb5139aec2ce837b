#include "engine/passes/2c_cast_shadows.h"

namespace edgesplat::passes {

gpu::Pass cast_shadows(const SplatLight& in) {
    return {"2c_cast_shadows", {{"2c_cast_shadows.comp", light_constants(in), gpu::Invocations{in.splat_count}}}};
}

}  // namespace edgesplat::passes

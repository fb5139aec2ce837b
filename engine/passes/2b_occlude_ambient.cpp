#include "engine/passes/2b_occlude_ambient.h"

namespace edgesplat::passes {

gpu::Specialization light_constants(const SplatLight& in) {
    return {{shader::SPEC_ISO_COUNT, in.iso_count},         {shader::SPEC_CLIP_KEEP, in.clip.keep},
            {shader::SPEC_CLIP_REMOVE, in.clip.remove},     {shader::SPEC_SURFACES, in.surfaces ? 1U : 0U},
            {shader::SPEC_TRANSFER, in.transfer ? 1U : 0U}, {shader::SPEC_BESIDE, in.beside ? 1U : 0U}};
}

gpu::Pass occlude_ambient(const SplatLight& in) {
    return {"2b_occlude_ambient", {{"2b_occlude_ambient.comp", light_constants(in), gpu::Invocations{in.splat_count}}}};
}

}  // namespace edgesplat::passes

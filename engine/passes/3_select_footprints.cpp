#include "engine/passes/3_select_footprints.h"

#include "engine/passes/kernel_constants.h"

namespace edgesplat::passes {

gpu::Pass select_footprints(std::uint64_t slots, const DrawVariant& variant) {
    gpu::Specialization constants = kernel_constants(variant);
    constants.emplace_back(shader::SPEC_TILES, variant.tiles ? 1U : 0U);
    constants.emplace_back(shader::SPEC_CULLED, variant.culled ? 1U : 0U);
    return {"3_select_footprints", {{"3_select_footprints.comp", constants, gpu::Invocations{slots}}}};
}

}  // namespace edgesplat::passes

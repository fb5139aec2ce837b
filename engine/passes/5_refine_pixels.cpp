#include "engine/passes/5_refine_pixels.h"

namespace edgesplat::passes {

gpu::Pass refine_pixels(const DrawVariant& variant, std::uint64_t tiles, std::uint32_t step) {
    const std::uint32_t across = shader::TILE / step;
    return {"5_refine_pixels",
            {{"5_refine_pixels.comp",
              {{shader::SPEC_STEP, step},
               {shader::SPEC_GROUP, across * across},
               {shader::SPEC_MIXED, variant.mixed ? 1U : 0U},
               {shader::SPEC_SURFACES, variant.surfaces ? 1U : 0U}},
              gpu::Workgroups{tiles}}}};
}

}  // namespace edgesplat::passes

#include "engine/passes/7_resolve.h"

namespace edgesplat::passes {

gpu::Pass resolve(const DrawVariant& variant, const glm::ivec2& size, bool gradient) {
    return {"7_resolve",
            {{"7_resolve.comp",
              {{shader::SPEC_PAYLOAD, variant.payload},
               {shader::SPEC_GRADIENT, gradient ? 1U : 0U},
               {shader::SPEC_TILES, variant.tiles ? 1U : 0U},
               {shader::SPEC_OUTLINES, variant.outlines ? 1U : 0U}},
              gpu::Grid{{size, 1}}}}};
}

}  // namespace edgesplat::passes

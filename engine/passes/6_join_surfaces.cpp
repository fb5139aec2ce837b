#include "engine/passes/6_join_surfaces.h"

namespace edgesplat::passes {

gpu::Pass join_surfaces(const DrawVariant& variant, const glm::ivec2& size) {
    gpu::Pass pass{"6_join_surfaces", {}};
    if (variant.mixed) pass.dispatches = {{"6_join_surfaces.comp", {}, gpu::per_pixel(size)}};
    return pass;
}

}  // namespace edgesplat::passes

#include "engine/passes/6_merge_surfaces.h"

namespace edgesplat::passes {

gpu::Pass merge_surfaces(Merge how, const glm::ivec2& size) {
    return {"6_merge_surfaces", {{"6_merge_surfaces.comp", {}, gpu::per_pixel(size), static_cast<std::uint32_t>(how)}}};
}

}  // namespace edgesplat::passes

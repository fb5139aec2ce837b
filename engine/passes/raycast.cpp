#include "engine/passes/raycast.h"

#include "shaders/shared/raycast_params.h"

namespace edgesplat::passes {

glm::ivec3 brick_count(const glm::ivec3& dims) {
    constexpr int side = 1 << shader::BRICK_SHIFT;
    return (dims + (side - 1)) / side;
}

gpu::Pass classify_bricks(const RaycastVariant& variant, const glm::ivec3& dims) {
    const gpu::Grid bricks{glm::uvec3(brick_count(dims))};
    gpu::Pass pass{"raycast_bricks",
                   {{"raycast_bricks.comp",
                     {{shader::SPEC_TRANSFER, variant.transfer ? 1 : 0},
                      {shader::SPEC_ISO_COUNT, variant.iso_count},
                      {shader::SPEC_RAY_FILTER, variant.filter}},
                     bricks}}};
    for (std::uint32_t axis = 0; axis < 3; ++axis)
        pass.dispatches.push_back({"raycast_leaps.comp", {{shader::SPEC_AXIS, axis}}, bricks});
    return pass;
}

gpu::Pass cast_rays(const RaycastVariant& variant, const glm::ivec2& size) {
    return {"raycast",
            {{variant.transfer ? "raycast_transfer.comp" : "raycast.comp",
              {{shader::SPEC_ISO_COUNT, variant.iso_count},
               {shader::SPEC_SKIP, variant.skip_empty ? 1 : 0},
               {shader::SPEC_RAY_LIGHT, variant.light},
               {shader::SPEC_RAY_FILTER, variant.filter},
               {shader::SPEC_NO_DATA, variant.no_data ? 1 : 0},
               {shader::SPEC_LABELS, variant.labels}},
              gpu::Grid{{size, 1}}}}};
}

}  // namespace edgesplat::passes

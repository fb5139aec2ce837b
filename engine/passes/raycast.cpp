#include "engine/passes/raycast.h"

#include "shaders/shared/raycast_params.h"

namespace edgesplat::passes {

glm::ivec3 brick_count(const glm::ivec3& dims) {
    constexpr int side = 1 << shader::BRICK_SHIFT;
    return (dims + (side - 1)) / side;
}

void classify_bricks(gpu::Commands& commands, const RaycastVariant& variant, const glm::ivec3& dims) {
    const glm::uvec3 groups = (glm::uvec3(brick_count(dims)) + glm::uvec3(7, 3, 1)) / glm::uvec3(8, 4, 2);
    const gpu::Groups all{groups.x, groups.y, groups.z};
    commands.dispatch("raycast_bricks.comp",
                      {{shader::SPEC_TRANSFER, variant.transfer ? 1 : 0},
                       {shader::SPEC_ISO_COUNT, variant.iso_count},
                       {shader::SPEC_RAY_FILTER, variant.filter}},
                      0, all);
    commands.barrier();
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
        commands.dispatch("raycast_leaps.comp", {{shader::SPEC_AXIS, axis}}, 0, all);
        commands.barrier();
    }
}

void cast_rays(gpu::Commands& commands, const RaycastVariant& variant, const glm::ivec2& size) {
    const gpu::Specialization constants{
        {shader::SPEC_ISO_COUNT, variant.iso_count},     {shader::SPEC_SKIP, variant.skip_empty ? 1 : 0},
        {shader::SPEC_RAY_LIGHT, variant.light},         {shader::SPEC_RAY_FILTER, variant.filter},
        {shader::SPEC_NO_DATA, variant.no_data ? 1 : 0}, {shader::SPEC_LABELS, variant.labels}};
    const glm::uvec2 groups = (glm::uvec2(size) + 7U) / 8U;
    commands.dispatch(variant.transfer ? "raycast_transfer.comp" : "raycast.comp", constants, 0, {groups.x, groups.y});
    commands.barrier();
}

}  // namespace edgesplat::passes

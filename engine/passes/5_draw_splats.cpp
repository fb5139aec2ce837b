#include "engine/passes/5_draw_splats.h"

#include "engine/passes/kernel_constants.h"

namespace edgesplat::passes {

std::vector<std::uint32_t> quad_indices() {
    std::vector<std::uint32_t> indices;
    for (std::uint32_t quad = 0; quad < shader::QUADS_PER_INSTANCE; ++quad) {
        for (const std::uint32_t corner : {0U, 1U, 2U, 2U, 1U, 3U})
            indices.push_back(4 * quad + corner);
    }
    return indices;
}

gpu::Specialization draw_constants(const DrawVariant& variant) {
    gpu::Specialization constants = kernel_constants(variant);
    constants.emplace_back(shader::SPEC_PAYLOAD, variant.payload);
    constants.emplace_back(shader::SPEC_NODES, variant.nodes);
    constants.emplace_back(shader::SPEC_SHADOWS, variant.shadows);
    constants.emplace_back(shader::SPEC_ISO_COUNT, variant.iso_count);
    constants.emplace_back(shader::SPEC_PIECES, variant.opaque ? 1U : 2U);
    constants.insert(constants.end(), variant.shading.begin(), variant.shading.end());
    return constants;
}

void draw_splats(gpu::Commands& commands, const DrawSplats& in, std::uint32_t group) {
    const auto& target = in.sheets.shape();
    const auto layers = static_cast<std::uint32_t>(target.layers);
    commands.begin_rendering(in.sheets, &in.depth, layers);
    commands.bind_draw({.vertex = "group_rect.vert",
                        .fragment = "5a_clear_sheets.frag",
                        .constants = {},
                        .color = target.format,
                        .depth = in.depth.shape().format},
                       group);
    commands.draw(4, layers);
    commands.bind_draw({.vertex = "5b_draw_splats.vert",
                        .fragment = "5b_draw_splats.frag",
                        .constants = draw_constants(in.variant),
                        .color = target.format,
                        .depth = in.depth.shape().format,
                        .blend = gpu::DrawState::Blend::Add,
                        .depth_use = gpu::DrawState::Depth::TestLess},
                       group);
    commands.begin_count();
    commands.draw_indirect(in.indices, in.draws, group * sizeof(shader::DrawCommand));
    commands.end_count();
    commands.end_rendering();
    commands.barrier();
}

}  // namespace edgesplat::passes

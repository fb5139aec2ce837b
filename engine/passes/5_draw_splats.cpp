#include "engine/passes/5_draw_splats.h"

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
    return {{shader::SPEC_FOOTPRINTS, static_cast<std::uint32_t>(variant.footprints)},
            {shader::SPEC_WARP, static_cast<std::uint32_t>(variant.warp)},
            {shader::SPEC_LIGHT, variant.lights},
            {shader::SPEC_PAYLOAD, variant.payload},
            {shader::SPEC_SLICED, variant.sliced ? 1U : 0U},
            {shader::SPEC_CURVED, variant.curved ? 1U : 0U},
            {shader::SPEC_WEIGHTED, variant.weighted ? 1U : 0U},
            {shader::SPEC_NODES, variant.nodes},
            {shader::SPEC_TRANSFER, variant.transfer ? 1U : 0U},
            {shader::SPEC_RESPONSE, variant.response ? 1U : 0U},
            {shader::SPEC_GLOSS, variant.gloss ? 1U : 0U},
            {shader::SPEC_LIT_EDGES, variant.lit_edges ? 1U : 0U},
            {shader::SPEC_SILHOUETTE, variant.silhouette ? 1U : 0U},
            {shader::SPEC_FOG, variant.fog ? 1U : 0U},
            {shader::SPEC_OCCLUSION, variant.occlusion ? 1U : 0U},
            {shader::SPEC_SHADOWS, variant.shadows},
            {shader::SPEC_CLIP_KEEP, variant.clip.keep},
            {shader::SPEC_CLIP_REMOVE, variant.clip.remove},
            {shader::SPEC_ANTIALIAS, variant.antialias ? 1U : 0U}};
}

void draw_splats(gpu::Commands& commands, const DrawSplats& in, std::uint32_t group) {
    const auto& target = in.sheets.shape();
    const vk::Rect2D area({0, 0},
                          {static_cast<std::uint32_t>(target.size.x), static_cast<std::uint32_t>(target.size.y)});
    const vk::RenderingAttachmentInfo color(in.sheets.view(), vk::ImageLayout::eGeneral, {}, {}, {},
                                            vk::AttachmentLoadOp::eLoad, vk::AttachmentStoreOp::eStore);
    const vk::RenderingAttachmentInfo depth(in.depth.view(), vk::ImageLayout::eGeneral, {}, {}, {},
                                            vk::AttachmentLoadOp::eLoad, vk::AttachmentStoreOp::eStore);
    const auto layers = static_cast<std::uint32_t>(target.layers);
    const auto& raw = commands.raw();

    raw.beginRendering(vk::RenderingInfo({}, area, layers, 0, color, &depth));
    raw.setViewport(0, vk::Viewport(0, 0, static_cast<float>(target.size.x), static_cast<float>(target.size.y), 0, 1));
    raw.setScissor(0, area);
    commands.bind_draw({.vertex = "group_rect.vert",
                        .fragment = "5a_clear_sheets.frag",
                        .constants = {},
                        .color = target.format,
                        .depth = in.depth.shape().format},
                       group);
    raw.draw(4, layers, 0, 0);
    commands.bind_draw({.vertex = "5b_draw_splats.vert",
                        .fragment = "5b_draw_splats.frag",
                        .constants = draw_constants(in.variant),
                        .color = target.format,
                        .depth = in.depth.shape().format,
                        .blend = gpu::DrawState::Blend::Add,
                        .depth_use = gpu::DrawState::Depth::TestLess},
                       group);
    raw.bindIndexBuffer(in.indices.handle(), 0, vk::IndexType::eUint32);
    commands.begin_count();
    raw.drawIndexedIndirect(in.draws.handle(), group * sizeof(shader::DrawCommand), 1, sizeof(shader::DrawCommand));
    commands.end_count();
    raw.endRendering();
    commands.barrier();
}

}  // namespace edgesplat::passes

#include "engine/passes/6_composite_sheet.h"

namespace edgesplat::passes {

void clear_accumulated(gpu::Commands& commands, const gpu::GpuImage& accumulated) {
    commands.raw().clearColorImage(accumulated.handle(), vk::ImageLayout::eGeneral, vk::ClearColorValue(),
                                   vk::ImageSubresourceRange(vk::ImageAspectFlagBits::eColor, 0, 1, 0, 1));
    commands.barrier();
}

void composite_sheet(gpu::Commands& commands, const gpu::GpuImage& accumulated, std::uint32_t payload,
                     std::uint32_t group) {
    const auto& target = accumulated.shape();
    const vk::Rect2D area({0, 0},
                          {static_cast<std::uint32_t>(target.size.x), static_cast<std::uint32_t>(target.size.y)});
    const vk::RenderingAttachmentInfo color(accumulated.view(), vk::ImageLayout::eGeneral, {}, {}, {},
                                            vk::AttachmentLoadOp::eLoad, vk::AttachmentStoreOp::eStore);
    const auto& raw = commands.raw();
    raw.beginRendering(vk::RenderingInfo({}, area, 1, 0, color));
    raw.setViewport(0, vk::Viewport(0, 0, static_cast<float>(target.size.x), static_cast<float>(target.size.y), 0, 1));
    raw.setScissor(0, area);
    const auto blend = payload == shader::PAYLOAD_TAU ? gpu::DrawState::Blend::Add : gpu::DrawState::Blend::Under;
    commands.bind_draw({.vertex = "group_rect.vert",
                        .fragment = "6_composite_sheet.frag",
                        .constants = {{shader::SPEC_PAYLOAD, payload}},
                        .color = target.format,
                        .blend = blend},
                       group);
    raw.draw(4, 1, 0, 0);
    raw.endRendering();
    commands.barrier();
}

}  // namespace edgesplat::passes

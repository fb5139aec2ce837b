#include "engine/passes/6_composite_sheet.h"

namespace edgesplat::passes {

void clear_accumulated(gpu::Commands& commands, const gpu::GpuImage& accumulated) {
    commands.clear(accumulated);
    commands.barrier();
}

void composite_sheet(gpu::Commands& commands, const gpu::GpuImage& accumulated, std::uint32_t payload,
                     std::uint32_t group) {
    commands.begin_rendering(accumulated);
    const auto blend = payload == shader::PAYLOAD_TAU ? gpu::DrawState::Blend::Add : gpu::DrawState::Blend::Under;
    commands.bind_draw({.vertex = "group_rect.vert",
                        .fragment = "6_composite_sheet.frag",
                        .constants = {{shader::SPEC_PAYLOAD, payload}},
                        .color = accumulated.shape().format,
                        .blend = blend},
                       group);
    commands.draw(4, 1);
    commands.end_rendering();
    commands.barrier();
}

}  // namespace edgesplat::passes

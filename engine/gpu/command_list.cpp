#include "engine/gpu/command_list.h"

#include <cstdint>

namespace edgesplat::gpu {
namespace {

using Stage = vk::PipelineStageFlagBits2;
using Access = vk::AccessFlagBits2;

class Recorder {
  public:
    explicit Recorder(const vk::raii::CommandBuffer& to) : to_(to) {}

    void operator()(const command::BindSet& c) const { to_.bindDescriptorSets(c.point, c.layout, 0, c.set, nullptr); }
    void operator()(const command::BindPipeline& c) const {
        to_.bindPipeline(c.point, c.pipeline);
        to_.pushConstants<std::uint32_t>(
            c.layout,
            vk::ShaderStageFlagBits::eCompute | vk::ShaderStageFlagBits::eFragment | vk::ShaderStageFlagBits::eVertex,
            0, c.number);
    }
    void operator()(const command::Dispatch& c) const { to_.dispatch(c.groups.x, c.groups.y, c.groups.z); }
    void operator()(const command::DispatchCounted& c) const { to_.dispatchIndirect(c.counts.handle, c.offset); }
    void operator()(const command::Barrier&) const {
        const vk::MemoryBarrier2 memory(Stage::eAllCommands, Access::eMemoryWrite, Stage::eAllCommands | Stage::eHost,
                                        Access::eMemoryRead | Access::eMemoryWrite | Access::eHostRead);
        to_.pipelineBarrier2(vk::DependencyInfo({}, memory));
    }
    void operator()(const command::Prepare& c) const {
        const vk::ImageMemoryBarrier2 image(
            Stage::eAllCommands, Access::eNone, Stage::eAllCommands, Access::eMemoryRead | Access::eMemoryWrite,
            vk::ImageLayout::eUndefined, vk::ImageLayout::eGeneral, VK_QUEUE_FAMILY_IGNORED, VK_QUEUE_FAMILY_IGNORED,
            c.image.handle, vk::ImageSubresourceRange(c.aspect, 0, 1, 0, VK_REMAINING_ARRAY_LAYERS));
        to_.pipelineBarrier2(vk::DependencyInfo({}, {}, {}, image));
    }
    void operator()(const command::Fill& c) const { to_.fillBuffer(c.buffer.handle, c.offset, c.bytes, c.value); }
    void operator()(const command::Update& c) const {
        to_.updateBuffer<std::uint32_t>(c.buffer.handle, c.offset, c.values);
    }
    void operator()(const command::CopyBuffer& c) const { to_.copyBuffer(c.from.handle, c.to.handle, c.parts); }
    void operator()(const command::CopyToImage& c) const {
        to_.copyBufferToImage(c.from.handle, c.to.handle, vk::ImageLayout::eGeneral, c.part);
    }
    void operator()(const command::CopyFromImage& c) const {
        to_.copyImageToBuffer(c.from.handle, vk::ImageLayout::eGeneral, c.to.handle, c.part);
    }
    void operator()(const command::Clear& c) const {
        to_.clearColorImage(c.image.handle, vk::ImageLayout::eGeneral, vk::ClearColorValue(),
                            vk::ImageSubresourceRange(vk::ImageAspectFlagBits::eColor, 0, 1, 0, 1));
    }
    void operator()(const command::BeginRendering& c) const {
        const auto attachment = [](const ViewUse& view) {
            return vk::RenderingAttachmentInfo(view.handle, vk::ImageLayout::eGeneral, {}, {}, {},
                                               vk::AttachmentLoadOp::eLoad, vk::AttachmentStoreOp::eStore);
        };
        const vk::RenderingAttachmentInfo color = attachment(c.color), depth = attachment(c.depth);
        const vk::Rect2D area({0, 0}, c.size);
        to_.beginRendering(vk::RenderingInfo({}, area, c.layers, 0, color, c.depth.handle ? &depth : nullptr));
        to_.setViewport(0,
                        vk::Viewport(0, 0, static_cast<float>(c.size.width), static_cast<float>(c.size.height), 0, 1));
        to_.setScissor(0, area);
    }
    void operator()(const command::EndRendering&) const { to_.endRendering(); }
    void operator()(const command::Draw& c) const { to_.draw(c.vertices, c.instances, 0, 0); }
    void operator()(const command::DrawIndirect& c) const {
        to_.bindIndexBuffer(c.indices.handle, 0, vk::IndexType::eUint32);
        to_.drawIndexedIndirect(c.draws.handle, c.offset, 1, sizeof(vk::DrawIndexedIndirectCommand));
    }
    void operator()(const command::ResetQueries& c) const { to_.resetQueryPool(c.pool, c.first, c.count); }
    void operator()(const command::Timestamp& c) const { to_.writeTimestamp2(Stage::eAllCommands, c.pool, c.at); }
    void operator()(const command::BeginQuery& c) const {
        to_.beginQuery(c.pool, c.at, c.precise ? vk::QueryControlFlagBits::ePrecise : vk::QueryControlFlags());
    }
    void operator()(const command::EndQuery& c) const { to_.endQuery(c.pool, c.at); }

  private:
    const vk::raii::CommandBuffer& to_;
};

}  // namespace

void record(const vk::raii::CommandBuffer& buffer, const CommandList& list) {
    buffer.begin(vk::CommandBufferBeginInfo());
    for (const Command& one : list)
        std::visit(Recorder(buffer), one);
    buffer.end();
}

}  // namespace edgesplat::gpu

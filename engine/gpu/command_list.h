// Commands as values: compared with those of an earlier run, or recorded.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>
#include <vulkan/vulkan_raii.hpp>

namespace edgesplat::gpu {

/// Thread counts of a dispatch; group counts follow from the shader's local size.
struct Groups {
    std::uint32_t x = 1, y = 1, z = 1;
    bool operator==(const Groups&) const = default;
};

/// A resource in a command: serials differ where handles were given anew.
template <typename Handle>
struct Use {
    Handle handle;
    std::uint64_t serial = 0;
    bool operator==(const Use&) const = default;
};
using BufferUse = Use<vk::Buffer>;
using ImageUse = Use<vk::Image>;
using ViewUse = Use<vk::ImageView>;

namespace command {

struct BindSet {
    vk::PipelineBindPoint point;
    vk::PipelineLayout layout;
    vk::DescriptorSet set;
    std::uint64_t version;  ///< a recording does not outlive a write to its set
    bool operator==(const BindSet&) const = default;
};
/// A pipeline with its push constant.
struct BindPipeline {
    vk::PipelineBindPoint point;
    vk::Pipeline pipeline;
    vk::PipelineLayout layout;
    std::uint32_t number;
    bool operator==(const BindPipeline&) const = default;
};
struct Dispatch {
    Groups groups;
    bool operator==(const Dispatch&) const = default;
};
/// Of as many groups as then stand at byte `offset` of `counts`: one recording serves whatever they are.
struct DispatchCounted {
    BufferUse counts;
    std::uint64_t offset;
    bool operator==(const DispatchCounted&) const = default;
};
/// Everything before, visible to everything after.
struct Barrier {
    bool operator==(const Barrier&) const = default;
};
/// Brings a fresh image into layout GENERAL.
struct Prepare {
    ImageUse image;
    vk::ImageAspectFlags aspect;
    bool operator==(const Prepare&) const = default;
};
struct Fill {
    BufferUse buffer;
    std::uint64_t offset, bytes;
    std::uint32_t value;
    bool operator==(const Fill&) const = default;
};
struct Update {
    BufferUse buffer;
    std::uint64_t offset;
    std::vector<std::uint32_t> values;
    bool operator==(const Update&) const = default;
};
struct CopyBuffer {
    BufferUse from, to;
    std::vector<vk::BufferCopy> parts;
    bool operator==(const CopyBuffer&) const = default;
};
struct CopyToImage {
    BufferUse from;
    ImageUse to;
    vk::BufferImageCopy part;
    bool operator==(const CopyToImage&) const = default;
};
struct CopyFromImage {
    ImageUse from;
    BufferUse to;
    vk::BufferImageCopy part;
    bool operator==(const CopyFromImage&) const = default;
};
/// To zero.
struct Clear {
    ImageUse image;
    bool operator==(const Clear&) const = default;
};
struct BeginRendering {
    ViewUse color, depth;  ///< depth: perhaps none
    vk::Extent2D size;
    std::uint32_t layers;
    bool operator==(const BeginRendering&) const = default;
};
struct EndRendering {
    bool operator==(const EndRendering&) const = default;
};
struct Draw {
    std::uint32_t vertices, instances;
    bool operator==(const Draw&) const = default;
};
struct DrawIndirect {
    BufferUse indices, draws;
    std::uint64_t offset;
    bool operator==(const DrawIndirect&) const = default;
};
struct ResetQueries {
    vk::QueryPool pool;
    std::uint32_t first, count;
    bool operator==(const ResetQueries&) const = default;
};
struct Timestamp {
    vk::QueryPool pool;
    std::uint32_t at;
    bool operator==(const Timestamp&) const = default;
};
struct BeginQuery {
    vk::QueryPool pool;
    std::uint32_t at;
    bool precise;
    bool operator==(const BeginQuery&) const = default;
};
struct EndQuery {
    vk::QueryPool pool;
    std::uint32_t at;
    bool operator==(const EndQuery&) const = default;
};

}  // namespace command

using Command = std::variant<command::BindSet, command::BindPipeline, command::Dispatch, command::DispatchCounted,
                             command::Barrier, command::Prepare, command::Fill, command::Update, command::CopyBuffer,
                             command::CopyToImage, command::CopyFromImage, command::Clear, command::BeginRendering,
                             command::EndRendering, command::Draw, command::DrawIndirect, command::ResetQueries,
                             command::Timestamp, command::BeginQuery, command::EndQuery>;

using CommandList = std::vector<Command>;

/// Records the whole list, begin and end included, to be submitted any number of times.
void record(const vk::raii::CommandBuffer& buffer, const CommandList& list);

}  // namespace edgesplat::gpu

// Recording and running one command buffer at a time, with the few commands that the passes are made of.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>
#include <vulkan/vulkan_raii.hpp>

#include "engine/gpu/buffer.h"
#include "engine/gpu/image.h"
#include "engine/gpu/pipelines.h"
#include "shaders/shared/frame_params.h"

namespace edgesplat::gpu {

/// Thread counts of a dispatch; group counts follow from the shader's local size.
struct Groups {
    std::uint32_t x = 1, y = 1, z = 1;
};

/// Enough groups of `local` invocations for `count`, folded into y beyond the 65535 that every device allows.
Groups groups_for(std::uint64_t count, std::uint32_t local);

/// One command buffer on the device's queue. Images stay in layout GENERAL and every barrier is global: the passes
/// depend on one another as wholes, and a finer barrier buys nothing there.
class Commands {
  public:
    Commands(const Device& device, Pipelines& pipelines, vk::DescriptorSet set);

    const vk::raii::CommandBuffer& raw() const { return buffer_; }

    /// Records `body`, submits it and waits until the device is done.
    void run(const std::function<void()>& body);

    void dispatch(const char* shader, const Specialization& constants, std::uint32_t number, Groups groups);
    void bind_draw(const DrawState& state, std::uint32_t number);
    /// Everything before, visible to everything after.
    void barrier();
    /// Brings fresh images into layout GENERAL.
    void prepare(std::initializer_list<const GpuImage*> images);

    /// Records `body` as a named span of device time; spans of one name add up. Must not nest.
    template <typename Body>
    void span(const char* name, const Body& body) {
        begin_span(name);
        body();
        end_span();
    }
    /// Milliseconds of the spans of the last run, in order of first use; empty without timestamps.
    std::vector<PassTime> span_times() const;

    /// Whether draws between begin_count and end_count are counted from the next run on. Only where the device can.
    void count_draws(bool on);
    /// Within one rendering; do nothing unless draws are counted.
    void begin_count();
    void end_count();
    /// Sums over the last run; nothing unless all of its draws were counted.
    std::optional<DrawCounts> draw_counts() const;

  private:
    void begin_span(const char* name);
    void end_span();
    void write_timestamp();
    const Device* device_;
    Pipelines* pipelines_;
    vk::DescriptorSet set_;
    bool draws_ = false;  ///< the set is bound for draws
    vk::raii::CommandPool pool_ = nullptr;
    vk::raii::CommandBuffer buffer_ = nullptr;
    vk::raii::Fence fence_ = nullptr;
    vk::raii::QueryPool queries_ = nullptr;
    std::vector<std::string> span_names_;
    vk::raii::QueryPool statistics_ = nullptr, samples_ = nullptr;  ///< a query per counted draw; absent: not counted
    std::uint32_t counted_ = 0;
};

}  // namespace edgesplat::gpu

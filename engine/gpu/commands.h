// Recording and running one list of commands at a time, with the few that the passes are made of.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>
#include <vulkan/vulkan_raii.hpp>

#include "engine/gpu/buffer.h"
#include "engine/gpu/descriptor_set.h"
#include "engine/gpu/image.h"
#include "engine/gpu/pipelines.h"
#include "shaders/shared/frame_params.h"

namespace edgesplat::gpu {

/// Numbers of a dispatch's workgroups.
struct Groups {
    std::uint32_t x = 1, y = 1, z = 1;
};

/// Enough groups of `local` invocations for `count`, folded into y beyond the 65535 that every device allows.
Groups groups_for(std::uint64_t count, std::uint32_t local);

/// Commands on the device's queue. Images stay in layout GENERAL and every barrier is global: the passes depend on one
/// another as wholes, and a finer barrier buys nothing there.
class Commands {
  public:
    /// How long the device may take for a run, ns: a software device may take minutes for a huge frame.
    static constexpr std::uint64_t kTimeout = 600'000'000'000;

    Commands(const Device& device, Pipelines& pipelines, const DescriptorSet& set);
    ~Commands();
    Commands(const Commands&) = delete;
    Commands& operator=(const Commands&) = delete;

    /// Records what `body` asks for, submits it and waits until the device is done. Throws Error where that takes
    /// longer than the time-out; the next run waits as long for it again.
    void run(const std::function<void()>& body);
    void set_timeout(std::uint64_t nanoseconds) { timeout_ = nanoseconds; }
    const DeviceProfile& profile() const { return device_->profile(); }
    /// How many lists the device was given.
    std::uint64_t submissions() const { return submissions_; }

    /// For the dispatches to come of this run; else they have the set of the constructor.
    void bind_compute_set(const DescriptorSet& set);
    void dispatch(const char* shader, const Specialization& constants, std::uint32_t number, Groups groups);
    /// Everything before, visible to everything after.
    void barrier();
    /// Brings fresh images into layout GENERAL.
    void prepare(std::initializer_list<const GpuImage*> images);

    /// `value` into `bytes` from `offset` on.
    void fill(const Buffer& buffer, std::uint32_t value, std::uint64_t offset = 0, std::uint64_t bytes = VK_WHOLE_SIZE);
    /// 65536 bytes at most.
    void update(const Buffer& buffer, std::uint64_t offset, std::span<const std::uint32_t> values);
    void copy(const Buffer& from, const Buffer& to, const std::vector<vk::BufferCopy>& parts);
    void copy(const Buffer& from, const GpuImage& to, const vk::BufferImageCopy& part);
    void copy(const GpuImage& from, const Buffer& to, const vk::BufferImageCopy& part);
    void clear(const GpuImage& image);
    /// What the host wrote into a buffer of Place::Shared, and what the device did; nothing where both see the same.
    void to_device(const Buffer& buffer);
    void to_host(const Buffer& buffer);

    /// Into all of `color` and `layers` of it, over what is there.
    void begin_rendering(const GpuImage& color, const GpuImage* depth = nullptr, std::uint32_t layers = 1);
    void bind_draw(const DrawState& state, std::uint32_t number);
    void draw(std::uint32_t vertices, std::uint32_t instances);
    /// What `draws` says at byte `offset` (vk::DrawIndexedIndirectCommand).
    void draw_indirect(const Buffer& indices, const Buffer& draws, std::uint64_t offset);
    void end_rendering();

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
    /// Waits for what was submitted.
    void finish();
    void begin_span(const char* name);
    void end_span();
    void write_timestamp();
    /// With the push constant of every pass.
    void bind_pipeline(vk::PipelineBindPoint point, vk::Pipeline pipeline, std::uint32_t number);
    const Device* device_;
    Pipelines* pipelines_;
    const DescriptorSet* set_;
    bool draws_ = false;  ///< the set is bound for draws
    vk::raii::CommandPool pool_;
    vk::raii::CommandBuffer buffer_ = nullptr;
    std::uint64_t submissions_ = 0;
    vk::raii::Fence fence_ = nullptr;
    bool busy_ = false;  ///< the fence is that of a list that was submitted
    std::uint64_t timeout_ = kTimeout;
    vk::raii::QueryPool queries_ = nullptr;
    std::vector<std::string> span_names_;
    vk::raii::QueryPool statistics_ = nullptr, samples_ = nullptr;  ///< a query per counted draw; absent: not counted
    std::uint32_t counted_ = 0;
};

}  // namespace edgesplat::gpu

namespace edgesplat {

/// Adds times to those of the same name.
void add_times(std::vector<PassTime>& sums, const std::vector<PassTime>& times);

}  // namespace edgesplat

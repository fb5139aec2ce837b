// Records and runs one command list at a time, with the few commands that the passes need.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>
#include <vulkan/vulkan_raii.hpp>

#include "engine/gpu/buffer.h"
#include "engine/gpu/descriptor_set.h"
#include "engine/gpu/dispatch.h"
#include "engine/gpu/image.h"
#include "shaders/shared/frame_params.h"

namespace edgesplat::gpu {

/// Commands on the device's queue. Images stay in layout GENERAL and every barrier is global: each pass depends on the
/// whole of the one before, so finer barriers save nothing.
class Commands {
  public:
    /// Time limit of a run, ns: a software device may need minutes for a huge frame.
    static constexpr std::uint64_t kTimeout = 600'000'000'000;
    /// Workgroups along an axis that every device allows; longer lines are folded.
    static constexpr std::uint32_t kMostGroups = 65535;

    Commands(const Device& device, Pipelines& pipelines, const DescriptorSet& set);
    ~Commands();
    Commands(const Commands&) = delete;
    Commands& operator=(const Commands&) = delete;

    /// Records the commands of `body`, submits them and waits for the device. Throws Error after the time limit; the
    /// next run then first waits up to the limit for this one.
    void run(const std::function<void()>& body);
    void set_timeout(std::uint64_t nanoseconds) { timeout_ = nanoseconds; }
    const DeviceProfile& profile() const { return device_->profile(); }
    /// Number of command lists submitted so far.
    std::uint64_t submissions() const { return submissions_; }

    /// The descriptor set of the following dispatches of this run; the default is the constructor's.
    void bind_compute_set(const DescriptorSet& set);
    void dispatch(const Dispatch& dispatch);
    /// Records the dispatches of a pass as a span of device time.
    void pass(const Pass& pass);
    /// Workgroups of a dispatch along each axis.
    glm::uvec3 workgroups(const Dispatch& dispatch) const;
    /// Replaces kMostGroups: a test folds short dispatches, too.
    void fold_above(std::uint32_t groups) { most_groups_ = groups; }
    /// Makes all earlier writes visible to all later commands and to the host.
    void barrier();
    /// Transitions new images to layout GENERAL.
    void prepare(std::initializer_list<const GpuImage*> images);

    /// Writes `value` to every word of `bytes` bytes from `offset` on.
    void fill(const Buffer& buffer, std::uint32_t value, std::uint64_t offset = 0, std::uint64_t bytes = VK_WHOLE_SIZE);
    void copy(const Buffer& from, const Buffer& to, const std::vector<vk::BufferCopy>& parts);
    void copy(const Buffer& from, const GpuImage& to, const vk::BufferImageCopy& part);
    void copy(const GpuImage& from, const Buffer& to, const vk::BufferImageCopy& part);
    void clear(const GpuImage& image);
    /// Copy a Place::Shared buffer from host to device, and back; no-ops if both use the same memory.
    void to_device(const Buffer& buffer);
    void to_host(const Buffer& buffer);

    /// Draws into the whole of `color`, into `layers` of its layers; the old contents are kept.
    void begin_rendering(const GpuImage& color, const GpuImage* depth = nullptr, std::uint32_t layers = 1);
    void bind_draw(const DrawState& state, std::uint32_t number);
    void draw(std::uint32_t vertices, std::uint32_t instances);
    /// Draws by the vk::DrawIndexedIndirectCommand at byte `offset` of `draws`.
    void draw_indirect(const Buffer& indices, const Buffer& draws, std::uint64_t offset);
    void end_rendering();

    /// Records `body` as a named span of device time; spans of equal name are added. Must not nest.
    template <typename Body>
    void span(const char* name, const Body& body) {
        begin_span(name);
        body();
        end_span();
    }
    /// Times of the last run's spans (ms), in order of first use; empty without timestamps.
    std::vector<PassTime> span_times() const;

    /// From the next run on, counts the draws between begin_count and end_count; only if the device can.
    void count_draws(bool on);
    /// Both within one rendering; no-ops unless draws are counted.
    void begin_count();
    void end_count();
    /// Sums over the last run; nullopt unless all of its draws were counted.
    std::optional<DrawCounts> draw_counts() const;

  private:
    /// Waits for the submitted list.
    void finish();
    void begin_span(const char* name);
    void end_span();
    void write_timestamp();
    /// Binds the pipeline and sets the passes' push constant to `number`.
    void bind_pipeline(vk::PipelineBindPoint point, vk::Pipeline pipeline, std::uint32_t number);
    const Device* device_;
    Pipelines* pipelines_;
    const DescriptorSet* set_;
    bool draws_ = false;  ///< the set is bound for draws
    vk::raii::CommandPool pool_;
    vk::raii::CommandBuffer buffer_ = nullptr;
    std::uint64_t submissions_ = 0;
    vk::raii::Fence fence_ = nullptr;
    bool busy_ = false;  ///< a list was submitted and its fence not yet waited for
    std::uint64_t timeout_ = kTimeout;
    std::uint32_t most_groups_ = kMostGroups;
    vk::raii::QueryPool queries_ = nullptr;
    std::vector<std::string> span_names_;
    vk::raii::QueryPool statistics_ = nullptr, samples_ = nullptr;  ///< a query per counted draw; null: no counting
    std::uint32_t counted_ = 0;
};

}  // namespace edgesplat::gpu

namespace edgesplat {

/// Adds each time to the sum of the same name.
void add_times(std::vector<PassTime>& sums, const std::vector<PassTime>& times);

}  // namespace edgesplat

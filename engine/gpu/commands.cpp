#include "engine/gpu/commands.h"

#include <algorithm>

#include "engine/error.h"
#include "engine/gpu/shader.h"

namespace edgesplat::gpu {
namespace {

// Two per span. A frame of 10^4 sheets in groups of 8 has 2500 spans.
constexpr std::uint32_t kMaxTimestamps = 8192;
// Queries that are reset together, when the first is written: validation keeps a state for every query ever reset.
constexpr std::uint32_t kTimestampsAtOnce = 64;
constexpr std::uint32_t kMaxCountedDraws = 8192;

using Stage = vk::PipelineStageFlagBits2;
using Access = vk::AccessFlagBits2;

}  // namespace

Commands::Commands(const Device& device, Pipelines& pipelines, const DescriptorSet& set)
    : device_(&device),
      pipelines_(&pipelines),
      set_(&set),
      pool_(device.handle(), {vk::CommandPoolCreateFlagBits::eResetCommandBuffer, device.queue_family()}),
      fence_(device.handle(), vk::FenceCreateInfo{}) {
    const vk::CommandBufferAllocateInfo one(*pool_, vk::CommandBufferLevel::ePrimary, 1);
    buffer_ = std::move(vk::raii::CommandBuffers(device.handle(), one).front());
    if (device.timestamp_period() > 0)
        queries_ = vk::raii::QueryPool(device.handle(), {{}, vk::QueryType::eTimestamp, kMaxTimestamps});
}

Commands::~Commands() {
    if (!busy_) return;
    // The device still uses objects that are freed next. The C function is used because it does not throw.
    const VkFence fence = *fence_;
    (void)device_->handle().getDispatcher()->vkWaitForFences(*device_->handle(), 1, &fence, VK_TRUE, kTimeout);
}

void Commands::finish() {
    if (!busy_) return;
    const auto waited = device_->handle().waitForFences(*fence_, VK_TRUE, timeout_);
    if (waited != vk::Result::eSuccess)
        fail("the device {} did not finish within {} s", device_->info().name, static_cast<double>(timeout_) * 1e-9);
    device_->handle().resetFences(*fence_);
    busy_ = false;
}

void Commands::run(const std::function<void()>& body) {
    finish();  // after a time-out the device may still execute the last run
    span_names_.clear();
    counted_ = 0;
    draws_ = false;
    buffer_.reset();  // a body that threw leaves it half recorded
    buffer_.begin({vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
    for (const vk::raii::QueryPool* pool : {&statistics_, &samples_})
        if (**pool) buffer_.resetQueryPool(**pool, 0, kMaxCountedDraws);
    bind_compute_set(*set_);
    body();
    barrier();
    buffer_.end();
    const vk::CommandBufferSubmitInfo command(*buffer_);
    device_->queue().submit2(vk::SubmitInfo2({}, {}, command), *fence_);
    ++submissions_;
    busy_ = true;
    finish();
}

void Commands::bind_compute_set(const DescriptorSet& set) {
    buffer_.bindDescriptorSets(vk::PipelineBindPoint::eCompute, pipelines_->layout(), 0, set.handle(), nullptr);
}

void Commands::bind_pipeline(vk::PipelineBindPoint point, vk::Pipeline pipeline, std::uint32_t number) {
    buffer_.bindPipeline(point, pipeline);
    buffer_.pushConstants<std::uint32_t>(
        pipelines_->layout(),
        vk::ShaderStageFlagBits::eCompute | vk::ShaderStageFlagBits::eFragment | vk::ShaderStageFlagBits::eVertex, 0,
        number);
}

glm::uvec3 Commands::workgroups(const Dispatch& dispatch) const {
    const auto folded = [&](std::uint64_t groups) {
        const std::uint64_t all = std::max<std::uint64_t>(groups, 1);
        const std::uint64_t rows = (all + most_groups_ - 1) / most_groups_;
        return glm::uvec3((all + rows - 1) / rows, rows, 1);
    };
    if (const auto* groups = std::get_if<Workgroups>(&dispatch.size)) return folded(groups->count);
    if (const auto* columns = std::get_if<Columns>(&dispatch.size)) return {columns->workgroups, 1, 1};
    const glm::uvec3 local = local_size(dispatch.shader);
    if (const auto* line = std::get_if<Invocations>(&dispatch.size))
        return folded((line->count + local.x - 1) / local.x);
    return (std::get<Grid>(dispatch.size).invocations + local - 1U) / local;
}

void Commands::dispatch(const Dispatch& dispatch) {
    bind_pipeline(vk::PipelineBindPoint::eCompute, pipelines_->compute(dispatch.shader, dispatch.constants),
                  dispatch.number);
    const glm::uvec3 groups = workgroups(dispatch);
    buffer_.dispatch(groups.x, groups.y, groups.z);
    barrier();
}

void Commands::pass(const Pass& pass) {
    if (pass.dispatches.empty()) return;
    span(pass.name, [&] {
        for (const Dispatch& each : pass.dispatches)
            dispatch(each);
    });
}

void Commands::barrier() {
    const vk::MemoryBarrier2 memory(Stage::eAllCommands, Access::eMemoryWrite, Stage::eAllCommands | Stage::eHost,
                                    Access::eMemoryRead | Access::eMemoryWrite | Access::eHostRead);
    buffer_.pipelineBarrier2(vk::DependencyInfo({}, memory));
}

void Commands::prepare(std::initializer_list<const GpuImage*> images) {
    for (const GpuImage* image : images) {
        const vk::ImageMemoryBarrier2 fresh(
            Stage::eAllCommands, Access::eNone, Stage::eAllCommands, Access::eMemoryRead | Access::eMemoryWrite,
            vk::ImageLayout::eUndefined, vk::ImageLayout::eGeneral, VK_QUEUE_FAMILY_IGNORED, VK_QUEUE_FAMILY_IGNORED,
            image->handle(), vk::ImageSubresourceRange(image->aspect(), 0, 1, 0, VK_REMAINING_ARRAY_LAYERS));
        buffer_.pipelineBarrier2(vk::DependencyInfo({}, {}, {}, fresh));
    }
}

void Commands::fill(const Buffer& buffer, std::uint32_t value, std::uint64_t offset, std::uint64_t bytes) {
    buffer_.fillBuffer(buffer.handle(), offset, bytes, value);
}

void Commands::copy(const Buffer& from, const Buffer& to, const std::vector<vk::BufferCopy>& parts) {
    buffer_.copyBuffer(from.handle(), to.handle(), parts);
}

void Commands::copy(const Buffer& from, const GpuImage& to, const vk::BufferImageCopy& part) {
    buffer_.copyBufferToImage(from.handle(), to.handle(), vk::ImageLayout::eGeneral, part);
}

void Commands::copy(const GpuImage& from, const Buffer& to, const vk::BufferImageCopy& part) {
    buffer_.copyImageToBuffer(from.handle(), vk::ImageLayout::eGeneral, to.handle(), part);
}

void Commands::clear(const GpuImage& image) {
    buffer_.clearColorImage(image.handle(), vk::ImageLayout::eGeneral, vk::ClearColorValue(),
                            vk::ImageSubresourceRange(vk::ImageAspectFlagBits::eColor, 0, 1, 0, 1));
}

void Commands::to_device(const Buffer& buffer) {
    if (buffer.host_copy() == nullptr) return;
    copy(*buffer.host_copy(), buffer, {{0, 0, buffer.bytes()}});
    barrier();
}

void Commands::to_host(const Buffer& buffer) {
    if (buffer.host_copy() == nullptr) return;
    copy(buffer, *buffer.host_copy(), {{0, 0, buffer.bytes()}});
    barrier();
}

void Commands::begin_rendering(const GpuImage& color, const GpuImage* depth, std::uint32_t layers) {
    const auto attachment = [](const GpuImage* image) {
        return vk::RenderingAttachmentInfo(image == nullptr ? vk::ImageView() : image->view(),
                                           vk::ImageLayout::eGeneral, {}, {}, {}, vk::AttachmentLoadOp::eLoad,
                                           vk::AttachmentStoreOp::eStore);
    };
    const vk::RenderingAttachmentInfo colors = attachment(&color), depths = attachment(depth);
    const glm::uvec2 size(color.shape().size);
    const vk::Rect2D area({0, 0}, {size.x, size.y});
    buffer_.beginRendering(vk::RenderingInfo({}, area, layers, 0, colors, depth == nullptr ? nullptr : &depths));
    buffer_.setViewport(0, vk::Viewport(0, 0, static_cast<float>(size.x), static_cast<float>(size.y), 0, 1));
    buffer_.setScissor(0, area);
}

void Commands::bind_draw(const DrawState& state, std::uint32_t number) {
    bind_pipeline(vk::PipelineBindPoint::eGraphics, pipelines_->draw(state), number);
    // After the pipeline: a driver may need the bound pipeline to bind a descriptor set with uniform blocks.
    if (!draws_)
        buffer_.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, pipelines_->layout(), 0, set_->handle(), nullptr);
    draws_ = true;
}

void Commands::draw(std::uint32_t vertices, std::uint32_t instances) {
    buffer_.draw(vertices, instances, 0, 0);
}

void Commands::draw_indirect(const Buffer& indices, const Buffer& draws, std::uint64_t offset) {
    buffer_.bindIndexBuffer(indices.handle(), 0, vk::IndexType::eUint32);
    buffer_.drawIndexedIndirect(draws.handle(), offset, 1, sizeof(vk::DrawIndexedIndirectCommand));
}

void Commands::end_rendering() {
    buffer_.endRendering();
}

void Commands::write_timestamp() {
    const auto at = static_cast<std::uint32_t>(span_names_.size());
    if (!*queries_ || at >= kMaxTimestamps) return;
    const bool late = device_->profile().late_timestamps;
    if (late) barrier();
    if (at % kTimestampsAtOnce == 0) buffer_.resetQueryPool(*queries_, at, kTimestampsAtOnce);
    buffer_.writeTimestamp2(Stage::eAllCommands, *queries_, at);
    if (late) barrier();
}

void Commands::begin_span(const char* name) {
    write_timestamp();
    span_names_.emplace_back(name);
}

void Commands::end_span() {
    write_timestamp();
    span_names_.emplace_back();
}

std::vector<PassTime> Commands::span_times() const {
    std::vector<PassTime> times;
    const auto count = std::min<std::size_t>(span_names_.size(), kMaxTimestamps) / 2 * 2;
    if (!*queries_ || count == 0) return times;
    const auto [result, ticks] = queries_.getResults<std::uint64_t>(
        0, static_cast<std::uint32_t>(count), count * sizeof(std::uint64_t), sizeof(std::uint64_t),
        vk::QueryResultFlagBits::e64 | vk::QueryResultFlagBits::eWait);
    if (result != vk::Result::eSuccess) return times;
    for (std::size_t i = 0; i < count; i += 2) {
        auto found =
            std::find_if(times.begin(), times.end(), [&](const PassTime& t) { return t.name == span_names_[i]; });
        if (found == times.end()) found = times.insert(times.end(), PassTime{span_names_[i], 0.0});
        found->milliseconds += static_cast<double>(ticks[i + 1] - ticks[i]) * device_->timestamp_period() * 1e-6;
    }
    return times;
}

void Commands::count_draws(bool on) {
    statistics_ = nullptr;
    samples_ = nullptr;
    if (!on || !device_->counts_draws()) return;
    using Statistic = vk::QueryPipelineStatisticFlagBits;
    statistics_ = vk::raii::QueryPool(device_->handle(),
                                      {{},
                                       vk::QueryType::ePipelineStatistics,
                                       kMaxCountedDraws,
                                       Statistic::eVertexShaderInvocations | Statistic::eFragmentShaderInvocations});
    samples_ = vk::raii::QueryPool(device_->handle(), {{}, vk::QueryType::eOcclusion, kMaxCountedDraws});
}

void Commands::begin_count() {
    if (!*statistics_ || counted_ >= kMaxCountedDraws) return;
    buffer_.beginQuery(*statistics_, counted_, {});
    buffer_.beginQuery(*samples_, counted_, vk::QueryControlFlagBits::ePrecise);
}

void Commands::end_count() {
    if (!*statistics_) return;
    if (counted_ < kMaxCountedDraws) {
        buffer_.endQuery(*samples_, counted_);
        buffer_.endQuery(*statistics_, counted_);
    }
    ++counted_;
}

std::optional<DrawCounts> Commands::draw_counts() const {
    if (!*statistics_ || counted_ == 0 || counted_ > kMaxCountedDraws) return std::nullopt;
    const auto results = [&](const vk::raii::QueryPool& pool, std::size_t numbers) {
        const std::size_t stride = numbers * sizeof(std::uint64_t);
        return pool
            .getResults<std::uint64_t>(0, counted_, counted_ * stride, stride,
                                       vk::QueryResultFlagBits::e64 | vk::QueryResultFlagBits::eWait)
            .second;
    };
    const std::vector<std::uint64_t> statistics = results(statistics_, 2), samples = results(samples_, 1);
    DrawCounts counts;
    for (std::size_t i = 0; i < counted_; ++i) {
        counts.vertices += statistics[2 * i];
        counts.fragments += statistics[2 * i + 1];
        counts.shaded += samples[i];
    }
    return counts;
}

}  // namespace edgesplat::gpu

namespace edgesplat {

void add_times(std::vector<PassTime>& sums, const std::vector<PassTime>& times) {
    for (const PassTime& time : times) {
        const auto same = std::ranges::find(sums, time.name, &PassTime::name);
        if (same == sums.end())
            sums.push_back(time);
        else
            same->milliseconds += time.milliseconds;
    }
}

}  // namespace edgesplat

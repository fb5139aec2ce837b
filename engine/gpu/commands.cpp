#include "engine/gpu/commands.h"

#include <algorithm>

#include "engine/error.h"

namespace edgesplat::gpu {
namespace {

// Two per span; a frame of 10^4 sheets in groups of 8 has 2500 spans.
constexpr std::uint32_t kMaxTimestamps = 8192;
// Reset together when the first of them is written: validation keeps a state for every query that is ever reset.
constexpr std::uint32_t kTimestampsAtOnce = 64;
constexpr std::uint32_t kMaxCounted = 8192;
constexpr std::uint64_t kTimeout = 600'000'000'000;  // ns; a software device may take minutes for a huge frame

}  // namespace

Groups groups_for(std::uint64_t count, std::uint32_t local) {
    const std::uint64_t groups = std::max<std::uint64_t>((count + local - 1) / local, 1);
    const std::uint64_t rows = (groups + 65534) / 65535;
    return {static_cast<std::uint32_t>((groups + rows - 1) / rows), static_cast<std::uint32_t>(rows), 1};
}

Commands::Commands(const Device& device, Pipelines& pipelines, vk::DescriptorSet set)
    : device_(&device),
      pipelines_(&pipelines),
      set_(set),
      pool_(device.handle(), {vk::CommandPoolCreateFlagBits::eResetCommandBuffer, device.queue_family()}) {
    buffer_ =
        std::move(vk::raii::CommandBuffers(device.handle(), {*pool_, vk::CommandBufferLevel::ePrimary, 1}).front());
    fence_ = vk::raii::Fence(device.handle(), vk::FenceCreateInfo{});
    if (device.timestamp_period() > 0) {
        queries_ = vk::raii::QueryPool(device.handle(), {{}, vk::QueryType::eTimestamp, kMaxTimestamps});
    }
}

void Commands::run(const std::function<void()>& body) {
    span_names_.clear();
    buffer_.begin({vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
    counted_ = 0;
    for (const vk::raii::QueryPool* pool : {&statistics_, &samples_})
        if (**pool) buffer_.resetQueryPool(**pool, 0, kMaxCounted);
    buffer_.bindDescriptorSets(vk::PipelineBindPoint::eCompute, pipelines_->layout(), 0, set_, nullptr);
    draws_ = false;
    try {
        body();
    } catch (...) {
        // Else the next one would begin in the middle of this.
        (*buffer_).reset({}, *device_->handle().getDispatcher());
        throw;
    }
    barrier();
    buffer_.end();
    const vk::CommandBufferSubmitInfo command(*buffer_);
    device_->queue().submit2(vk::SubmitInfo2({}, {}, command), *fence_);
    const auto waited = device_->handle().waitForFences(*fence_, VK_TRUE, kTimeout);
    if (waited != vk::Result::eSuccess) fail("the device {} did not finish within 10 minutes", device_->info().name);
    device_->handle().resetFences(*fence_);
}

void Commands::dispatch(const char* shader, const Specialization& constants, std::uint32_t number, Groups groups) {
    buffer_.bindPipeline(vk::PipelineBindPoint::eCompute, pipelines_->compute(shader, constants));
    buffer_.pushConstants<std::uint32_t>(
        pipelines_->layout(),
        vk::ShaderStageFlagBits::eCompute | vk::ShaderStageFlagBits::eFragment | vk::ShaderStageFlagBits::eVertex, 0,
        number);
    buffer_.dispatch(groups.x, groups.y, groups.z);
}

void Commands::bind_draw(const DrawState& state, std::uint32_t number) {
    buffer_.bindPipeline(vk::PipelineBindPoint::eGraphics, pipelines_->draw(state));
    // Not before: lavapipe looks for the pipeline of a descriptor set with uniform blocks.
    if (!draws_) buffer_.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, pipelines_->layout(), 0, set_, nullptr);
    draws_ = true;
    buffer_.pushConstants<std::uint32_t>(
        pipelines_->layout(),
        vk::ShaderStageFlagBits::eCompute | vk::ShaderStageFlagBits::eFragment | vk::ShaderStageFlagBits::eVertex, 0,
        number);
}

void Commands::barrier() {
    using Stage = vk::PipelineStageFlagBits2;
    using Access = vk::AccessFlagBits2;
    const vk::MemoryBarrier2 memory(Stage::eAllCommands, Access::eMemoryWrite, Stage::eAllCommands | Stage::eHost,
                                    Access::eMemoryRead | Access::eMemoryWrite | Access::eHostRead);
    buffer_.pipelineBarrier2(vk::DependencyInfo({}, memory));
}

void Commands::prepare(std::initializer_list<const GpuImage*> images) {
    using Stage = vk::PipelineStageFlagBits2;
    using Access = vk::AccessFlagBits2;
    std::vector<vk::ImageMemoryBarrier2> barriers;
    for (const GpuImage* image : images) {
        barriers.emplace_back(
            Stage::eAllCommands, Access::eNone, Stage::eAllCommands, Access::eMemoryRead | Access::eMemoryWrite,
            vk::ImageLayout::eUndefined, vk::ImageLayout::eGeneral, VK_QUEUE_FAMILY_IGNORED, VK_QUEUE_FAMILY_IGNORED,
            image->handle(), vk::ImageSubresourceRange(image->aspect(), 0, 1, 0, VK_REMAINING_ARRAY_LAYERS));
    }
    buffer_.pipelineBarrier2(vk::DependencyInfo({}, {}, {}, barriers));
}

void Commands::write_timestamp() {
    const auto at = static_cast<std::uint32_t>(span_names_.size());
    if (!*queries_ || at >= kMaxTimestamps) return;
    // lavapipe writes timestamps when it next rasterises, which may be after dispatches that were recorded later.
    const bool late = device_->is_software();
    if (late) barrier();
    if (at % kTimestampsAtOnce == 0) buffer_.resetQueryPool(*queries_, at, kTimestampsAtOnce);
    buffer_.writeTimestamp2(vk::PipelineStageFlagBits2::eAllCommands, *queries_, at);
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
                                       kMaxCounted,
                                       Statistic::eVertexShaderInvocations | Statistic::eFragmentShaderInvocations});
    samples_ = vk::raii::QueryPool(device_->handle(), {{}, vk::QueryType::eOcclusion, kMaxCounted});
}

void Commands::begin_count() {
    if (!*statistics_ || counted_ >= kMaxCounted) return;
    buffer_.beginQuery(*statistics_, counted_);
    buffer_.beginQuery(*samples_, counted_, vk::QueryControlFlagBits::ePrecise);
}

void Commands::end_count() {
    if (!*statistics_) return;
    if (counted_ < kMaxCounted) {
        buffer_.endQuery(*samples_, counted_);
        buffer_.endQuery(*statistics_, counted_);
    }
    ++counted_;
}

std::optional<DrawCounts> Commands::draw_counts() const {
    if (!*statistics_ || counted_ == 0 || counted_ > kMaxCounted) return std::nullopt;
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

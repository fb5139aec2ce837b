#include "engine/gpu/commands.h"

#include <algorithm>

#include "engine/error.h"

namespace edgesplat::gpu {
namespace {

// Two per span; a frame of 10^4 sheets in groups of 8 has 2500 spans.
constexpr std::uint32_t kMaxTimestamps = 8192;
// Reset together when the first of them is written: validation keeps a state for every query that is ever reset.
constexpr std::uint32_t kTimestampsAtOnce = 64;
constexpr std::uint32_t kMaxCountedDraws = 8192;
constexpr std::size_t kMaxCountedDispatches = 4096;  // dispatches whose groups are counted; 48 KiB

}  // namespace

Groups groups_for(std::uint64_t count, std::uint32_t local) {
    const std::uint64_t groups = std::max<std::uint64_t>((count + local - 1) / local, 1);
    const std::uint64_t rows = (groups + 65534) / 65535;
    return {static_cast<std::uint32_t>((groups + rows - 1) / rows), static_cast<std::uint32_t>(rows), 1};
}

std::size_t Commands::group_count_bytes() {
    return kMaxCountedDispatches * sizeof(Groups);
}

Commands::Commands(const Device& device, Pipelines& pipelines, const DescriptorSet& set)
    : device_(&device),
      pipelines_(&pipelines),
      set_(&set),
      group_counts_(device, group_count_bytes(), Buffer::Place::Host, "numbers of groups"),
      kept_(device),
      fence_(device.handle(), vk::FenceCreateInfo{}) {
    if (device.timestamp_period() > 0)
        queries_ = vk::raii::QueryPool(device.handle(), {{}, vk::QueryType::eTimestamp, kMaxTimestamps});
}

Commands::~Commands() {
    if (!busy_) return;
    // It is still at what is freed next. By way of the C function, which does not throw.
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
    finish();  // where the last run was given up, the device may still be at it
    list_.clear();
    span_names_.clear();
    counted_ = 0;
    draws_ = false;
    dispatches_ = 0;
    for (const vk::raii::QueryPool* pool : {&statistics_, &samples_})
        if (**pool) list_.emplace_back(command::ResetQueries{**pool, 0, kMaxCountedDraws});
    bind_compute_set(*set_);
    body();
    barrier();
    const vk::CommandBufferSubmitInfo command(kept_.of(list_));
    device_->queue().submit2(vk::SubmitInfo2({}, {}, command), *fence_);
    busy_ = true;
    finish();
}

void Commands::bind_compute_set(const DescriptorSet& set) {
    list_.emplace_back(
        command::BindSet{vk::PipelineBindPoint::eCompute, pipelines_->layout(), set.handle(), set.version()});
}

void Commands::dispatch(const char* shader, const Specialization& constants, std::uint32_t number, Groups groups) {
    list_.emplace_back(command::BindPipeline{vk::PipelineBindPoint::eCompute, pipelines_->compute(shader, constants),
                                             pipelines_->layout(), number});
    if (dispatches_ == kMaxCountedDispatches) {
        list_.emplace_back(command::Dispatch{groups});
        return;
    }
    group_counts_.mapped<Groups>(kMaxCountedDispatches)[dispatches_] = groups;
    list_.emplace_back(command::DispatchCounted{group_counts_.use(), dispatches_ * sizeof(Groups)});
    ++dispatches_;
}

void Commands::prepare(std::initializer_list<const GpuImage*> images) {
    for (const GpuImage* image : images)
        list_.emplace_back(command::Prepare{image->use(), image->aspect()});
}

void Commands::fill(const Buffer& buffer, std::uint32_t value, std::uint64_t offset, std::uint64_t bytes) {
    list_.emplace_back(command::Fill{buffer.use(), offset, bytes, value});
}

void Commands::update(const Buffer& buffer, std::uint64_t offset, std::span<const std::uint32_t> values) {
    list_.emplace_back(command::Update{buffer.use(), offset, {values.begin(), values.end()}});
}

void Commands::copy(const Buffer& from, const Buffer& to, std::vector<vk::BufferCopy> parts) {
    list_.emplace_back(command::CopyBuffer{from.use(), to.use(), std::move(parts)});
}

void Commands::copy(const Buffer& from, const GpuImage& to, const vk::BufferImageCopy& part) {
    list_.emplace_back(command::CopyToImage{from.use(), to.use(), part});
}

void Commands::copy(const GpuImage& from, const Buffer& to, const vk::BufferImageCopy& part) {
    list_.emplace_back(command::CopyFromImage{from.use(), to.use(), part});
}

void Commands::clear(const GpuImage& image) {
    list_.emplace_back(command::Clear{image.use()});
}

void Commands::begin_rendering(const GpuImage& color, const GpuImage* depth, std::uint32_t layers) {
    const glm::uvec2 size(color.shape().size);
    list_.emplace_back(command::BeginRendering{
        color.view_use(), depth == nullptr ? ViewUse() : depth->view_use(), {size.x, size.y}, layers});
}

void Commands::bind_draw(const DrawState& state, std::uint32_t number) {
    list_.emplace_back(
        command::BindPipeline{vk::PipelineBindPoint::eGraphics, pipelines_->draw(state), pipelines_->layout(), number});
    // Not before: lavapipe looks for the pipeline of a descriptor set with uniform blocks.
    if (!draws_)
        list_.emplace_back(
            command::BindSet{vk::PipelineBindPoint::eGraphics, pipelines_->layout(), set_->handle(), set_->version()});
    draws_ = true;
}

void Commands::draw(std::uint32_t vertices, std::uint32_t instances) {
    list_.emplace_back(command::Draw{vertices, instances});
}

void Commands::draw_indirect(const Buffer& indices, const Buffer& draws, std::uint64_t offset) {
    list_.emplace_back(command::DrawIndirect{indices.use(), draws.use(), offset});
}

void Commands::end_rendering() {
    list_.emplace_back(command::EndRendering());
}

void Commands::write_timestamp() {
    const auto at = static_cast<std::uint32_t>(span_names_.size());
    if (!*queries_ || at >= kMaxTimestamps) return;
    // lavapipe writes timestamps when it next rasterises, which may be after dispatches that were recorded later.
    const bool late = device_->is_software();
    if (late) barrier();
    if (at % kTimestampsAtOnce == 0) list_.emplace_back(command::ResetQueries{*queries_, at, kTimestampsAtOnce});
    list_.emplace_back(command::Timestamp{*queries_, at});
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
    kept_.clear();  // the pools' handles may be given anew
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
    list_.emplace_back(command::BeginQuery{*statistics_, counted_, false});
    list_.emplace_back(command::BeginQuery{*samples_, counted_, true});
}

void Commands::end_count() {
    if (!*statistics_) return;
    if (counted_ < kMaxCountedDraws) {
        list_.emplace_back(command::EndQuery{*samples_, counted_});
        list_.emplace_back(command::EndQuery{*statistics_, counted_});
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

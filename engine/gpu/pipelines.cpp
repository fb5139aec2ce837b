#include "engine/gpu/pipelines.h"

#include <fmt/format.h>

#include <array>
#include <chrono>

#include "engine/gpu/shader.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/frame_params.h"

namespace edgesplat::gpu {
namespace {

std::string key_of(const char* name, const Specialization& constants) {
    std::string key = name;
    for (const auto& [id, value] : constants)
        key += fmt::format(",{}={}", id, value);
    return key;
}

/// Specialization constants in Vulkan's layout; must live until the pipeline is created.
struct SpecializationData {
    std::vector<std::uint32_t> values;
    std::vector<vk::SpecializationMapEntry> entries;
    vk::SpecializationInfo info;

    explicit SpecializationData(const Specialization& constants) {
        for (const auto& [id, value] : constants) {
            entries.emplace_back(id, static_cast<std::uint32_t>(values.size() * sizeof(std::uint32_t)),
                                 sizeof(std::uint32_t));
            values.push_back(value);
        }
        info.setMapEntries(entries).setData<std::uint32_t>(values);
    }
};

vk::PipelineColorBlendAttachmentState blend_state(DrawState::Blend blend) {
    using Factor = vk::BlendFactor;
    using Channel = vk::ColorComponentFlagBits;
    vk::PipelineColorBlendAttachmentState state;
    state.colorWriteMask = Channel::eR | Channel::eG | Channel::eB | Channel::eA;
    if (blend == DrawState::Blend::None) return state;
    state.blendEnable = VK_TRUE;
    // Under: the new colour is behind the target's, both premultiplied.
    const auto source = blend == DrawState::Blend::Add ? Factor::eOne : Factor::eOneMinusDstAlpha;
    state.setSrcColorBlendFactor(source).setDstColorBlendFactor(Factor::eOne);
    state.setSrcAlphaBlendFactor(source).setDstAlphaBlendFactor(Factor::eOne);
    return state;
}

}  // namespace

Pipelines::Pipelines(const Device& device, const std::filesystem::path& cache_folder)
    : device_(&device), cache_(device, cache_folder) {
    using Type = vk::DescriptorType;
    const auto stages =
        vk::ShaderStageFlagBits::eCompute | vk::ShaderStageFlagBits::eVertex | vk::ShaderStageFlagBits::eFragment;
    std::array<vk::DescriptorSetLayoutBinding, shader::BIND_COUNT> bindings;
    for (std::uint32_t i = 0; i < shader::BIND_COUNT; ++i) {
        const auto type = i < shader::BIND_SHEETS    ? Type::eStorageImage
                          : i < shader::BIND_SCENE   ? Type::eCombinedImageSampler
                          : i < shader::BIND_PICTURE ? Type::eUniformBuffer
                                                     : Type::eStorageTexelBuffer;
        bindings.at(i) = {i, type, 1, stages};
    }
    set_layout_ = vk::raii::DescriptorSetLayout(device.handle(), {{}, bindings});
    const vk::PushConstantRange push(stages, 0, sizeof(std::uint32_t));
    layout_ = vk::raii::PipelineLayout(device.handle(), {{}, *set_layout_, push});
}

vk::raii::ShaderModule Pipelines::load(const char* shader) const {
    const auto words = find_shader(shader);
    return {device_->handle(), vk::ShaderModuleCreateInfo({}, words.size_bytes(), words.data())};
}

std::vector<PipelineVariant> Pipelines::used() const {
    const std::lock_guard lock(mutex_);
    std::vector<PipelineVariant> variants;
    for (const auto& [key, made] : made_)
        if (made.used) variants.push_back(made.variant);
    return variants;
}

void Pipelines::forget_used() {
    const std::lock_guard lock(mutex_);
    for (auto& [key, made] : made_)
        made.used = false;
}

Specialization Pipelines::with_drivers(Specialization constants) const {
    if (!device_->loads_texels()) constants.emplace_back(shader::SPEC_TEXELS, 0U);
    if (!device_->profile().loops) constants.emplace_back(shader::SPEC_LOOPS, 0U);
    return constants;
}

vk::raii::Pipeline Pipelines::create_compute(const char* shader, const Specialization& constants) const {
    const auto module = load(shader);
    const SpecializationData data(with_drivers(constants));
    const vk::PipelineShaderStageCreateInfo stage({}, vk::ShaderStageFlagBits::eCompute, *module, "main", &data.info);
    return {device_->handle(), cache_.handle(), vk::ComputePipelineCreateInfo({}, stage, *layout_)};
}

template <typename Create>
Pipelines::Made Pipelines::timed(const PipelineVariant& variant, const Create& create) {
    const auto start = std::chrono::steady_clock::now();
    Made made{create(), variant};
    made.milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    return made;
}

template <typename Create>
vk::Pipeline Pipelines::provide(const std::string& key, const PipelineVariant& variant, const Create& create) {
    std::unique_lock lock(mutex_);
    work_done_.wait(lock, [&] { return !in_work_.contains(key); });
    auto found = made_.find(key);
    if (found == made_.end()) {
        lock.unlock();
        Made made = timed(variant, create);
        lock.lock();
        found = made_.emplace(key, std::move(made)).first;
    }
    Made& made = found->second;
    if (made.error) {
        const std::exception_ptr error = made.error;
        made_.erase(found);
        std::rethrow_exception(error);
    }
    if (!made.counted) {
        ++creation_.count;
        creation_.milliseconds += made.milliseconds;
        cache_.mark_changed();
    }
    made.counted = made.used = true;
    return *made.pipeline;
}

vk::Pipeline Pipelines::compute(const char* shader, const Specialization& constants) {
    return provide(key_of(shader, constants), {{shader}, constants}, [&] { return create_compute(shader, constants); });
}

void Pipelines::create_ahead_now(const std::stop_token& stop, const std::vector<PipelineVariant>& variants) {
    for (const PipelineVariant& variant : variants) {
        if (variant.shaders.size() != 1) continue;
        const char* const shader = variant.shaders.front();
        const std::string key = key_of(shader, variant.constants);
        {
            const std::lock_guard lock(mutex_);
            if (stop.stop_requested()) return;
            if (made_.contains(key) || !in_work_.insert(key).second) continue;
        }
        Made made;
        try {
            made = timed(variant, [&] { return create_compute(shader, variant.constants); });
        } catch (...) {
            made.error = std::current_exception();
        }
        {
            const std::lock_guard lock(mutex_);
            made_.emplace(key, std::move(made));
            in_work_.erase(key);
        }
        work_done_.notify_all();
    }
}

void Pipelines::create_ahead(std::vector<PipelineVariant> variants) {
    ahead_ = std::jthread(
        [this, wanted = std::move(variants)](const std::stop_token& stop) { create_ahead_now(stop, wanted); });
}

vk::Pipeline Pipelines::draw(const DrawState& state) {
    const std::string key = key_of(state.fragment, state.constants) +
                            fmt::format(" {} {} {} {}", state.vertex, vk::to_string(state.color),
                                        vk::to_string(state.depth), static_cast<int>(state.blend));
    return provide(key, {{state.vertex, state.fragment}, state.constants}, [&] { return create_draw(state); });
}

vk::raii::Pipeline Pipelines::create_draw(const DrawState& state) const {
    const auto vertex = load(state.vertex), fragment = load(state.fragment);
    const SpecializationData data(with_drivers(state.constants));
    const std::array stages{
        vk::PipelineShaderStageCreateInfo({}, vk::ShaderStageFlagBits::eVertex, *vertex, "main", &data.info),
        vk::PipelineShaderStageCreateInfo({}, vk::ShaderStageFlagBits::eFragment, *fragment, "main", &data.info)};
    const vk::PipelineVertexInputStateCreateInfo no_vertices;
    const auto topology = state.depth_use == DrawState::Depth::TestLess ? vk::PrimitiveTopology::eTriangleList
                                                                        : vk::PrimitiveTopology::eTriangleStrip;
    const vk::PipelineInputAssemblyStateCreateInfo assembly({}, topology);
    vk::PipelineViewportStateCreateInfo viewport;
    viewport.viewportCount = viewport.scissorCount = 1;
    vk::PipelineRasterizationStateCreateInfo raster;
    raster.lineWidth = 1.0F;
    const vk::PipelineMultisampleStateCreateInfo samples;
    vk::PipelineDepthStencilStateCreateInfo depth;
    if (state.depth != vk::Format::eUndefined) {
        const bool write = state.depth_use == DrawState::Depth::Write;
        depth.setDepthTestEnable(VK_TRUE).setDepthWriteEnable(write ? VK_TRUE : VK_FALSE);
        depth.setDepthCompareOp(write ? vk::CompareOp::eAlways : vk::CompareOp::eLess);
    }
    const auto attachment = blend_state(state.blend);
    vk::PipelineColorBlendStateCreateInfo blend;
    blend.setAttachments(attachment);
    const std::array dynamics{vk::DynamicState::eViewport, vk::DynamicState::eScissor};
    const vk::PipelineDynamicStateCreateInfo dynamic({}, dynamics);
    const vk::PipelineRenderingCreateInfo rendering(0, state.color, state.depth);
    vk::GraphicsPipelineCreateInfo info({}, stages, &no_vertices, &assembly, nullptr, &viewport, &raster, &samples,
                                        &depth, &blend, &dynamic, *layout_);
    info.pNext = &rendering;
    return {device_->handle(), cache_.handle(), info};
}

}  // namespace edgesplat::gpu

// Creates pipelines on first use and keeps them, by shader name and specialization constants.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>
#include <vulkan/vulkan_raii.hpp>

#include "engine/gpu/pipeline_cache.h"

namespace edgesplat::gpu {

/// (constant id, value) pairs; shaders/shared/limits.h names the ids.
using Specialization = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

/// Everything that selects the pipeline of a draw into float targets.
struct DrawState {
    const char* vertex;
    const char* fragment;
    Specialization constants;
    vk::Format color;
    vk::Format depth = vk::Format::eUndefined;  ///< undefined: no depth attachment
    enum class Blend { None, Add, Under } blend = Blend::None;
    enum class Depth { Write, TestLess } depth_use = Depth::Write;
};

/// Shaders and constants that identify a pipeline.
struct PipelineVariant {
    std::vector<const char*> shaders;  ///< names, one per stage
    Specialization constants;          ///< the same for all stages
};

/// Number of pipelines created so far, and the time that took.
struct PipelineCreation {
    std::uint64_t count = 0;
    double milliseconds = 0;
};

class Pipelines {
  public:
    /// `cache_folder`: folder of the pipeline cache file; empty: no cache.
    Pipelines(const Device& device, const std::filesystem::path& cache_folder);

    vk::Pipeline compute(const char* shader, const Specialization& constants);
    vk::Pipeline draw(const DrawState& state);
    /// Every variant used since forget_used.
    std::vector<PipelineVariant> used() const;
    void forget_used();
    const PipelineCreation& creation() const { return creation_; }
    PipelineCache& cache() { return cache_; }

    vk::PipelineLayout layout() const { return *layout_; }
    vk::DescriptorSetLayout set_layout() const { return *set_layout_; }

  private:
    vk::raii::ShaderModule load(const char* shader) const;
    /// Adds the constants that the device's profile sets.
    Specialization with_drivers(Specialization constants) const;
    const Device* device_;
    PipelineCache cache_;
    vk::raii::DescriptorSetLayout set_layout_ = nullptr;
    vk::raii::PipelineLayout layout_ = nullptr;
    struct Made {
        vk::raii::Pipeline pipeline;
        PipelineVariant variant;
        bool used = true;
    };
    static vk::Pipeline use(Made& made);
    void count_creation(std::chrono::steady_clock::time_point start);
    std::map<std::string, Made> made_;
    PipelineCreation creation_;
};

}  // namespace edgesplat::gpu

// Pipelines by shader name and specialization constants, made on first use and kept.
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

/// (constant id, value) pairs: shaders/shared/limits.h names the ids.
using Specialization = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

/// A draw into float targets.
struct DrawState {
    const char* vertex;
    const char* fragment;
    Specialization constants;
    vk::Format color;
    vk::Format depth = vk::Format::eUndefined;  ///< undefined: no depth attachment
    enum class Blend { None, Add, Under } blend = Blend::None;
    enum class Depth { Write, TestLess } depth_use = Depth::Write;
};

/// A pipeline by what it is made of.
struct PipelineVariant {
    std::vector<const char*> shaders;  ///< names, one a stage
    Specialization constants;          ///< of all of them
};

/// What making pipelines took so far.
struct PipelineCreation {
    std::uint64_t count = 0;
    double milliseconds = 0;
};

class Pipelines {
  public:
    /// `cache_folder`: where compiled pipelines are kept for the next start; empty: nowhere.
    Pipelines(const Device& device, const std::filesystem::path& cache_folder);

    vk::Pipeline compute(const char* shader, const Specialization& constants);
    vk::Pipeline draw(const DrawState& state);
    /// Every variant that was asked for since forget_used.
    std::vector<PipelineVariant> used() const;
    void forget_used();
    const PipelineCreation& creation() const { return creation_; }
    PipelineCache& cache() { return cache_; }

    vk::PipelineLayout layout() const { return *layout_; }
    vk::DescriptorSetLayout set_layout() const { return *set_layout_; }

  private:
    vk::raii::ShaderModule load(const char* shader) const;
    /// And what the device's profile chooses.
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

// Creates pipelines on first use, or ahead of it on a thread, and keeps them, by shader name and specialization
// constants.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <exception>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <thread>
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

/// Number of pipelines used so far, and the time that their creation took; ahead of their use, time of another thread.
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
    /// Starts to create compute pipelines that will be used, in this order, while the caller does other work. Variants
    /// for draws are ignored. An error is thrown when the pipeline is used.
    void create_ahead(std::vector<PipelineVariant> variants);
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
    struct Made {
        vk::raii::Pipeline pipeline = nullptr;
        PipelineVariant variant;
        double milliseconds = 0;   ///< of its creation
        std::exception_ptr error;  ///< of a creation ahead
        bool counted = false, used = false;
    };
    template <typename Create>
    static Made timed(const PipelineVariant& variant, const Create& create);
    /// The pipeline of that key, which `create` makes unless there is one or another thread is making it.
    template <typename Create>
    vk::Pipeline provide(const std::string& key, const PipelineVariant& variant, const Create& create);
    vk::raii::Pipeline create_compute(const char* shader, const Specialization& constants) const;
    vk::raii::Pipeline create_draw(const DrawState& state) const;
    void create_ahead_now(const std::stop_token& stop, const std::vector<PipelineVariant>& variants);

    const Device* device_;
    PipelineCache cache_;
    vk::raii::DescriptorSetLayout set_layout_ = nullptr;
    vk::raii::PipelineLayout layout_ = nullptr;
    PipelineCreation creation_;
    mutable std::mutex mutex_;  ///< of what both threads use: the next two
    std::map<std::string, Made> made_;
    std::set<std::string> in_work_;      ///< keys of pipelines that a thread is making
    std::condition_variable work_done_;  ///< a key left in_work_
    std::jthread ahead_;                 ///< last: ends before the other members are destroyed
};

}  // namespace edgesplat::gpu

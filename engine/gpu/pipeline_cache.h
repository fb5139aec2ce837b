// Compiled pipelines on disk, so that the next start need not compile them again.
#pragma once

#include <filesystem>
#include <vulkan/vulkan_raii.hpp>

#include "engine/gpu/device.h"

namespace edgesplat::gpu {

/// One file a device and driver, in the folder of footprint tables; no folder: nothing is kept. A damaged, truncated or
/// foreign file counts as none.
class PipelineCache {
  public:
    PipelineCache(const Device& device, const std::filesystem::path& folder);
    PipelineCache(const PipelineCache&) = delete;
    PipelineCache& operator=(const PipelineCache&) = delete;
    PipelineCache(PipelineCache&&) = default;
    PipelineCache& operator=(PipelineCache&&) = delete;
    ~PipelineCache();

    const vk::raii::PipelineCache& handle() const { return cache_; }
    /// Bytes that were read.
    std::size_t loaded_bytes() const { return loaded_; }
    /// What is compiled from now on is worth writing.
    void note_new() { changed_ = true; }
    /// Writes beside the file and renames, if there is anything new; safe for several processes at once. Whether all is
    /// well: a folder that cannot be written costs the next start its time, and this one nothing.
    bool save();

  private:
    std::filesystem::path file_;
    vk::raii::PipelineCache cache_ = nullptr;
    std::size_t loaded_ = 0;
    bool changed_ = false;
};

}  // namespace edgesplat::gpu

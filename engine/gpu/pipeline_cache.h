// Keeps compiled pipelines on disk, so that the next start does not compile them again.
#pragma once

#include <filesystem>
#include <vulkan/vulkan_raii.hpp>

#include "engine/gpu/device.h"

namespace edgesplat::gpu {

/// One file per device and driver in `folder`, which also has the footprint tables; an empty path: no file. A damaged,
/// truncated or foreign file is ignored.
class PipelineCache {
  public:
    PipelineCache(const Device& device, const std::filesystem::path& folder);
    PipelineCache(const PipelineCache&) = delete;
    PipelineCache& operator=(const PipelineCache&) = delete;
    PipelineCache(PipelineCache&&) = default;
    PipelineCache& operator=(PipelineCache&&) = delete;
    ~PipelineCache();

    const vk::raii::PipelineCache& handle() const { return cache_; }
    /// Bytes read from the file.
    std::size_t loaded_bytes() const { return loaded_; }
    /// A pipeline was compiled: the next save() writes the file.
    void mark_changed() { changed_ = true; }
    /// Writes the file if pipelines were added: to a temporary file, then by renaming, which is safe with several
    /// processes. Returns false if that fails; then only the next start is slower.
    bool save();

  private:
    std::filesystem::path file_;
    vk::raii::PipelineCache cache_ = nullptr;
    std::size_t loaded_ = 0;
    bool changed_ = false;
};

}  // namespace edgesplat::gpu

// Keeps one resolution of a volume on the device: as a whole, or one block at a time.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "engine/culling/brick_ranges.h"
#include "engine/plan/device_session.h"
#include "engine/volume/changed_box.h"
#include "engine/volume/volume.h"

namespace edgesplat {

/// Part of a volume whose splats are collected at once, in voxels of the volume.
struct CollectionBlock {
    glm::ivec3 low{0}, size{0};            ///< voxels in the device's images: core and border
    glm::ivec3 core_low{0}, core_size{0};  ///< core: voxels that become splats
};
CollectionBlock whole_block(const glm::ivec3& dims);

class VolumeStore {
  public:
    explicit VolumeStore(DeviceSession& session) : session_(&session) {}

    const std::shared_ptr<const Volume>& volume() const { return volume_; }
    int level() const { return level_; }  ///< a voxel is 2^level original voxels long
    bool in_blocks() const { return in_blocks_; }
    const VolumeImages& images() const { return images_; }
    /// Of a volume as a whole; computed on first use.
    const BrickRanges& ranges();
    /// Box of samples that changed since the splats were collected; only for a volume as a whole.
    const std::optional<VoxelBox>& changed() const { return changed_; }

    /// Select the volume, and whether it is in blocks. Return whether that changed; then the images are freed.
    bool hold(std::shared_ptr<const Volume> volume, int level);
    bool hold_in_blocks(bool blocks);
    /// Replaces the volume by one with the same grid whose samples differ only in `box`, which may be empty.
    void change(std::shared_ptr<const Volume> next, const VoxelBox& box);
    void forget_changes() { changed_.reset(); }

    /// As a whole: upload samples, spline coefficients, or labels, that are not on the device. Return whether any were
    /// missing.
    bool provide();
    bool provide_coefficients();
    bool provide_labels();
    void release_coefficients() { images_.coefficients = {}; }

    /// In blocks: allocates images for blocks of up to that size; the old images are freed.
    void hold_blocks(const glm::ivec3& largest, bool coefficients, bool labels);
    /// Uploads a block's scaled samples, and their spline coefficients and labels if hold_blocks() allocated them.
    void load(const CollectionBlock& block, std::span<const float> samples);

  private:
    /// Allocates an image as its row in the resource table defines.
    void make(gpu::GpuImage VolumeImages::*image, const glm::ivec3& size);

    DeviceSession* session_;
    std::shared_ptr<const Volume> volume_;
    int level_ = 0;
    bool in_blocks_ = false;
    VolumeImages images_;
    BrickRanges ranges_;
    std::optional<VoxelBox> changed_, behind_;  ///< `behind_`: changed samples that are not uploaded yet
};

}  // namespace edgesplat

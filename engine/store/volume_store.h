// One resolution of a volume on the device: as a whole, or a block of it at a time.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "engine/plan/device_session.h"
#include "engine/volume/changed_box.h"
#include "engine/volume/volume.h"

namespace edgesplat {

/// Part of a volume whose splats are collected at once; voxels of the volume.
struct CollectionBlock {
    glm::ivec3 low{0}, size{0};            ///< what the device's images hold
    glm::ivec3 core_low{0}, core_size{0};  ///< what becomes splats
};
CollectionBlock whole_block(const glm::ivec3& dims);

class VolumeStore {
  public:
    explicit VolumeStore(DeviceSession& session) : session_(&session) {}

    const std::shared_ptr<const Volume>& volume() const { return volume_; }
    int level() const { return level_; }  ///< voxels of 2^level along each axis of the volume as it was set
    bool in_blocks() const { return in_blocks_; }
    const VolumeImages& images() const { return images_; }
    /// Samples that are others since the splats were collected, of a volume that is held as a whole.
    const std::optional<VoxelBox>& changed() const { return changed_; }

    /// What is held from now on. Whether something else was: then nothing is on the device any more.
    bool hold(std::shared_ptr<const Volume> volume, int level);
    bool hold_in_blocks(bool blocks);
    /// The same grid of voxels with other samples in a box, which may be empty.
    void change(std::shared_ptr<const Volume> next, const VoxelBox& box);
    void forget_changes() { changed_.reset(); }

    /// As a whole: brings to the device what is not there of the samples, of the spline through them. Whether anything
    /// was missing.
    bool provide();
    bool provide_coefficients();
    void release_coefficients() { images_.coefficients = {}; }

    /// In blocks: drops what is held, for blocks of up to that size.
    void hold_blocks(const glm::ivec3& largest, bool coefficients);
    /// Brings a block's scaled samples to the device, and their spline where there is room for one.
    void load(const CollectionBlock& block, std::span<const float> samples);

  private:
    /// Makes an image as a row of the table says.
    void make(gpu::GpuImage VolumeImages::*image, const glm::ivec3& size);

    DeviceSession* session_;
    std::shared_ptr<const Volume> volume_;
    int level_ = 0;
    bool in_blocks_ = false;
    VolumeImages images_;
    std::optional<VoxelBox> changed_, behind_;  ///< `behind_`: of these, what the image does not hold yet
};

}  // namespace edgesplat

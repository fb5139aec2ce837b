// What a picture is drawn into: images and buffers of its size, of its sheets and of its splats.
#pragma once

#include "engine/compositors/tiles/lists.h"
#include "engine/plan/device_session.h"
#include "engine/plan/resource_table.h"

namespace edgesplat {

/// Pixels as the numbers that they consist of.
inline std::span<const float> floats(std::span<const glm::vec4> pixels) {
    return {&pixels.front().x, 4 * pixels.size()};
}

class Targets {
  public:
    explicit Targets(DeviceSession& session);

    const TargetResources& resources() const { return resources_; }
    /// What the plan's passes take, as large as they need it; fills in addresses and the frame's parameters. Larger
    /// ones of earlier pictures stay, what pictures of this plan do without goes.
    void provide(FramePlan& plan, const SplatLists& splats);
    /// Room for the pairs of the largest chunk; brings the chunks to the device.
    void provide_chunks(FramePlan& plan, const Chunks& chunks);
    /// Frees everything of a picture but what any picture needs.
    void drop();

    /// (height, width) vec4 of the picture that was drawn with this plan.
    std::span<glm::vec4> pixels(const FramePlan& plan) const;

  private:
    void grow(const TargetBufferRow& row, std::uint64_t bytes);
    void provide_images(const FramePlan& plan);
    /// The footprints of kernels at faces, in the table.
    void fill_table(double depth);

    DeviceSession* session_;
    TargetResources resources_;
    double table_depth_ = -1;  ///< what the footprint table was made for, voxels; below 0: it was not
};

}  // namespace edgesplat

// Owns the images and buffers of a picture, sized by its pixels, sheets and splats.
#pragma once

#include "engine/frame/tiles/chunks.h"
#include "engine/plan/device_session.h"
#include "engine/plan/resource_table.h"
#include "engine/store/splat_store.h"

namespace edgesplat {

/// The components of the pixels.
inline std::span<const float> floats(std::span<const glm::vec4> pixels) {
    return {&pixels.front().x, 4 * pixels.size()};
}

class Targets {
  public:
    explicit Targets(DeviceSession& session);

    const TargetResources& resources() const { return resources_; }
    /// Allocates what the plan's passes need, fills in addresses and writes the frame's parameters. Larger resources
    /// of earlier pictures are reused; those that neither this plan nor `beside` needs are freed. `splats`: the lists
    /// of the plan's volumes. `beside`: the plans of the picture's other parts.
    void provide(FramePlan& plan, std::span<const CollectedSplats> splats, std::span<const FramePlan> beside = {});
    /// Allocates room for the pairs of the largest chunk and writes the chunks.
    void provide_chunks(FramePlan& plan, const Chunks& chunks);
    /// Frees all resources except those that every picture needs.
    void drop();

    /// Pixels of the picture drawn with this plan: (height, width) vec4.
    std::span<glm::vec4> pixels(const FramePlan& plan) const;

  private:
    void grow(const TargetBufferRow& row, std::uint64_t bytes);
    /// The block that the passes read.
    shader::FrameBlock& block() const { return resources_.frame.mapped<shader::FrameBlock>(1)[0]; }
    void provide_images(const FramePlan& plan);
    /// Uploads the table of footprints of kernels at faces, for face depth `depth` (voxels).
    void fill_table(double depth);

    DeviceSession* session_;
    TargetResources resources_;
    double table_depth_ = -1;  ///< face depth of the uploaded footprint table, voxels; below 0: none uploaded
};

}  // namespace edgesplat

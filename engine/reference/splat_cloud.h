// The splats of the model, found by where they reach: what direct evaluation asks for at a point.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/reference/footprints.h"
#include "engine/reference/reference_renderer.h"

namespace edgesplat::reference {

/// What one voxel has of one material. Lengths in voxels, index space.
struct ModelSplat {
    glm::dvec3 center{0};
    double reach = 0;        ///< from there on the kernel is 0
    double extinction = 0;   ///< per mm
    glm::dvec3 emission{0};  ///< extinction times lit colour
    std::uint32_t material = 0;
    const VoxelEdge* edge = nullptr;
    SplatRecord record;
};

/// Every voxel that absorbs, or lies beside what does, buried or not. `prepared` must outlive it.
class SplatCloud {
  public:
    SplatCloud(const PreparedVolume& prepared, const View& view, const Footprints& footprints);

    /// Where the line origin + t u, t >= 0, can be in reach of a splat. False: nowhere.
    bool clip(const glm::dvec3& origin, const glm::dvec3& u, double& begin, double& end) const;

    /// Voxels around p in which no splat is in reach; <= 0 where one may be.
    double empty_around(const glm::dvec3& p) const;

    /// The splats that may reach the segment from a to b, in the order of the voxels; replaces what `found` held.
    void gather(const glm::dvec3& a, const glm::dvec3& b, std::vector<const ModelSplat*>& found) const;

  private:
    void measure_emptiness();

    Field field_;
    std::vector<ModelSplat> splats_;
    std::vector<std::int32_t> splat_of_;   ///< per voxel the first of its splats, -1: it has none
    std::vector<std::uint8_t> clearance_;  ///< per voxel: Chebyshev distance to the nearest splat, at most 255
    double reach_ = 0;                     ///< from a voxel to where its kernel is 0, largest
    glm::dvec3 low_{0}, high_{0};          ///< box of the splats' reach
};

}  // namespace edgesplat::reference

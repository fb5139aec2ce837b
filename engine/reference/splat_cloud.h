// The model's splats with a search by position, for direct evaluation.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/reference/footprints.h"
#include "engine/reference/reference_renderer.h"

namespace edgesplat::reference {

/// One voxel's splat of one material. Lengths in voxels, index space.
struct ModelSplat {
    glm::dvec3 center{0};
    double reach = 0;        ///< radius beyond which the kernel is 0
    double extinction = 0;   ///< per mm
    glm::dvec3 emission{0};  ///< extinction times lit colour
    std::uint32_t material = 0;
    const VoxelEdge* edge = nullptr;
    SplatRecord record;
};

/// Splats of all voxels that absorb or lie beside translucent matter, buried or not. `prepared` must outlive it.
class SplatCloud {
  public:
    SplatCloud(const PreparedVolume& prepared, const View& view, const Footprints& footprints);

    /// Range of the line origin + t u, t >= 0, in which it can be in reach of a splat. False: nowhere.
    bool clip(const glm::dvec3& origin, const glm::dvec3& u, double& begin, double& end) const;

    /// Distance from p, voxels, within which no splat is in reach; <= 0 if a splat may be.
    double empty_distance(const glm::dvec3& p) const;

    /// Finds the splats that may reach the segment from a to b, in voxel order; `found` is overwritten.
    void gather(const glm::dvec3& a, const glm::dvec3& b, std::vector<const ModelSplat*>& found) const;

  private:
    void measure_emptiness();

    Field field_;
    std::vector<ModelSplat> splats_;
    std::vector<std::int32_t> splat_of_;   ///< per voxel: index of its first splat, -1: none
    std::vector<std::uint8_t> clearance_;  ///< per voxel: Chebyshev distance to the nearest splat, at most 255
    double reach_ = 0;                     ///< largest reach of a kernel
    glm::dvec3 low_{0}, high_{0};          ///< box of the splats' reach
};

}  // namespace edgesplat::reference

// The surface around labels, without the stairs of their voxels. docs/method/shading.md, Labels.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace edgesplat {

/// Distance, voxels, from which on a voxel's place beside the surface does not count any more.
inline constexpr int kLabelReach = 6;

/// Distance of each voxel from the surface around the voxels whose number is above 0, x fastest: voxels, positive in
/// them, at most kLabelReach. The surface is as smooth as it can be with each voxel on its own side of it.
std::vector<float> depth_in_labels(const std::vector<std::uint32_t>& numbers, const glm::ivec3& dims);

/// The same as a mask from 0 to 1, with the surface at 0.5.
std::vector<float> smoothed_mask(const std::vector<std::uint32_t>& numbers, const glm::ivec3& dims);

}  // namespace edgesplat

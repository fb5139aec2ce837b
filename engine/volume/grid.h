// Lengths and places in a grid of voxels.
#pragma once

#include <algorithm>
#include <cstddef>
#include <glm/glm.hpp>

#include "engine/volume/volume.h"

namespace edgesplat {

/// Place of voxel i in an array with `dims` voxels, x fastest.
inline std::size_t voxel_offset(const glm::ivec3& dims, const glm::ivec3& i) {
    return (static_cast<std::size_t>(i.z) * static_cast<std::size_t>(dims.y) + static_cast<std::size_t>(i.y)) *
               static_cast<std::size_t>(dims.x) +
           static_cast<std::size_t>(i.x);
}

/// Shortest voxel spacing, mm.
inline double shortest_spacing(const VolumeGeometry& geometry) {
    const glm::dvec3 spacing = geometry.spacing();
    return std::min({spacing.x, spacing.y, spacing.z});
}

}  // namespace edgesplat

// Surface splats: faces that agree with the field, and the pictures that their votes decide (docs/method/surfaces.md).
// Lengths are voxels, index space.
#pragma once

#include <span>
#include <vector>

#include "engine/reference/5_draw_splats.h"

namespace edgesplat::reference {

/// The face of a surface splat at voxel i of material m, which ends beside it. `noise`: standard deviation of the
/// samples' noise, scaled; `two_values`: Volume::two_values. `traced` is set if the field must be searched instead,
/// wherever the face's error, in D2, shows.
VoxelEdge fit_surface(const Field& field, const ScaledScene& scene, const std::vector<VoxelEdge>& surfels,
                      const glm::ivec3& i, int m, double noise, bool two_values);

/// The splats of the voxels that matter ends beside, ascending by voxel.
std::vector<SplatRecord> surface_splats(const Field& field, const ScaledScene& scene,
                                        const std::vector<VoxelEdge>& surfels, double noise, bool two_values,
                                        bool quantised);

/// One picture with one ray per pixel: premultiplied payload and opacity, row by row.
std::vector<glm::dvec4> draw_surfaces(std::span<const SplatRecord> records, const Field& field, const Scene& scene,
                                      const View& view, const Settings& settings, Payload payload);

}  // namespace edgesplat::reference

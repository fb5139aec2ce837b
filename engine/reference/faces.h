// Faces when splats are drawn: how they are stored, cut a kernel and appear along a ray (docs/method/faces.md). Lengths
// are voxels, index space.
#pragma once

#include "engine/reference/1_estimate_edges.h"
#include "footprints/face.h"

namespace edgesplat::reference {

/// H rounded to the 60 stored bits.
glm::dmat3 quantise_bending(const glm::dmat3& bending);

/// Whether the footprint table has the edge's face: one face without creases, bent so little that it counts as plane.
bool is_in_table(const VoxelEdge& edge, const Settings& settings);

/// The edge as the settings draw it: faces in the table are plane.
VoxelEdge drawn_edge(const VoxelEdge& edge, const Settings& settings);

}  // namespace edgesplat::reference

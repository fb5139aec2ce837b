// Traced faces: rays find the surface for splats that no quadric fits (docs/method/tiles.md, 5_trace_faces). Lengths
// are voxels, index space.
#pragma once

#include <vector>

#include "engine/reference/1_estimate_edges.h"

namespace edgesplat::reference {

/// Whether the samples around a voxel have only two values. Then the field between them is not known.
bool has_two_values(const Field& field, const glm::ivec3& i);

/// A part of a ray inside matter, voxels from the eye. It begins at -infinity if the traced range begins inside matter,
/// or at the volume's border if matter begins there. It ends at infinity if no end was found.
struct TracedPiece {
    double begin = 0, end = 0;
    glm::dvec3 n{0};     ///< unit normal out of the matter at the beginning
    bool upper = false;  ///< it begins at the interval's upper end
};

/// The pieces of a ray, and where tracing ended.
struct TracedRay {
    std::vector<TracedPiece> pieces;  ///< at most two
    double last = 0;
};

/// Traces the ray from `eye` along the unit vector u, between `first` and `last`. The field must have coefficients.
TracedRay trace_ray(const Field& field, const glm::dvec3& eye, const glm::dvec3& u, double first, double last,
                    const VoxelEdge::Interval& interval);

/// An edge as one ray meets it.
struct MetEdge {
    VoxelEdge edge;
    bool matter = true;  ///< false: the ray passes through none of the kernel's matter
};

/// The edge as the ray `ahead` u + p meets it; p is the ray's point nearest to the voxel, relative to it. A traced edge
/// becomes the plane that touches the field's surface where the ray enters the matter; other edges stay unchanged.
MetEdge met_edge(const VoxelEdge& edge, const Field& field, const glm::dvec3& eye, const glm::dvec3& u,
                 const glm::dvec3& p, double ahead);

}  // namespace edgesplat::reference

// Faces that rays find, of splats that no quadric fits (method.md, 5_trace_faces). Lengths are voxels, index space.
#pragma once

#include <vector>

#include "engine/reference/1_estimate_edges.h"

namespace edgesplat::reference {

/// Whether the samples around a voxel have two values alone: how the field goes between them is not known then.
bool has_two_values(const Field& field, const glm::ivec3& i);

/// A part of a ray that lies in matter, voxels from the eye. It begins at -infinity where what is looked at began in
/// it, at the volume's border where that does, and ends at infinity where no end was found.
struct TracedPiece {
    double begin = 0, end = 0;
    glm::dvec3 n{0};     ///< out of the matter where it begins, unit
    bool upper = false;  ///< the values beyond that end are higher
};

/// What was found of a ray, and how far along it was looked.
struct TracedRay {
    std::vector<TracedPiece> pieces;  ///< at most two
    double last = 0;
};

/// Between `first` and `last` along the unit vector u from `eye`. The field has coefficients.
TracedRay trace_ray(const Field& field, const glm::dvec3& eye, const glm::dvec3& u, double first, double last,
                    const VoxelEdge::Interval& interval);

/// An edge as one ray meets it.
struct MetEdge {
    VoxelEdge edge;
    bool matter = true;  ///< false: nothing of the kernel's matter is on the ray
};

/// Of an edge that is traced: the plane that touches the field's surface where the ray `ahead` u + p meets it, p its
/// point nearest to the voxel, relative to it; of others the edge itself.
MetEdge met_edge(const VoxelEdge& edge, const Field& field, const glm::dvec3& eye, const glm::dvec3& u,
                 const glm::dvec3& p, double ahead);

}  // namespace edgesplat::reference

// The rim of a grid within which one volume replaces the others.
#pragma once

#include <vector>

#include "engine/scene/effects.h"
#include "engine/volume/volume.h"

namespace edgesplat {

/// A side of the grid: half a voxel beyond its outermost samples, or, where another volume continues, a voxel within
/// them, up to where the field does not depend on samples that are missing. The normal points outwards.
struct RimSide {
    Plane plane;
    bool inner = false;  ///< another volume continues beyond it
    bool operator==(const RimSide&) const = default;
};

/// From the inner sides on, over `width`, kernels of the other volumes give way to those of the one within. Surfaces
/// end and begin at the sides.
struct Rim {
    std::vector<RimSide> sides;  ///< 6, the low and the high one along each axis; none if no volume replaces another
    double width = 0;            ///< mm
    bool within = false;         ///< seen from the volume that replaces the others
    bool any() const { return !sides.empty(); }
    /// Share of the volume's kernel at a place (world mm) that is drawn. The shares of both sum to 1.
    double share(const glm::dvec3& at) const;
    bool operator==(const Rim&) const = default;
};

/// `others`: the volumes that the one with this grid replaces. `width`: mm; 0: six voxels of the coarsest of them.
/// At most half of the grid's shortest side.
Rim rim_of(const VolumeGeometry& grid, const std::vector<VolumeGeometry>& others, double width);

}  // namespace edgesplat

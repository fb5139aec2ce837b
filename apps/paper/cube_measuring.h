// How sharp the cube of Figure 9 comes out, measured straight on along its hole.
#pragma once

#include "engine/renderer.h"
#include "tests/properties/measuring.h"

namespace edgesplat {

struct CubeQuality {
    double hole_radius = 0;    ///< of a circle as large as the hole in the data, where they are below one half; voxels
    test::EdgeProfiles faces;  ///< the four sides, against the true cube
    test::EdgeProfiles hole;   ///< the cylinder's wall at 64 angles, against a circle of `hole_radius`
};

/// Optical depth of the middle slices of `volume` (builtin:cube-hole, filtered) at 40 pixels per voxel. The renderer is
/// left with those slices.
CubeQuality cube_quality(Renderer& renderer, const Volume& volume, const Settings& settings);

}  // namespace edgesplat

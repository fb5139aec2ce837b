// Measures the sharpness of the cube of Figure 9 in a picture along its hole.
#pragma once

#include "engine/renderer.h"
#include "tests/properties/measuring.h"

namespace edgesplat {

struct CubeQuality {
    double hole_radius = 0;    ///< of the circle with the area of the data below one half; voxels
    test::EdgeProfiles faces;  ///< the four sides, against the true cube
    test::EdgeProfiles hole;   ///< the cylinder's wall at 64 angles, against a circle of `hole_radius`
};

/// Measures optical depth of the middle slices of `volume` (builtin:cube-hole, filtered) at 40 pixels per voxel. The
/// renderer keeps those slices as its volume.
CubeQuality cube_quality(Renderer& renderer, const Volume& volume, const Settings& settings);

}  // namespace edgesplat

// Measures sharpness, position and evenness of edges in pictures of the device. The program prints the figures; the
// tests check them.
#pragma once

#include <string>
#include <vector>

#include "tests/properties/measuring.h"

namespace edgesplat::test {

/// One of the compared rendering methods.
struct Method {
    std::string name;
    Settings settings;
};

/// The default first; then plain splatting, the estimators, the paper's curve and the paper's own method.
std::vector<Method> compared_methods();

/// Opacity of planes seen edge-on at 24 random orientations. Without the matter within `cut_away` voxels of the grid's
/// outermost samples: where the plane meets the grid's border, a kernel has only one of the two faces.
EdgeProfiles plane_edges(const Settings& settings, double cut_away);

/// Opaque solids, extinction 4 per voxel: where alpha is one half, relative to the edge of the solid's projection (the
/// ray that just touches it). Positive location: the solid is too large in the picture.
EdgeProfiles sphere_silhouettes(const Settings& settings);  ///< radius 9.3, 16 directions
EdgeProfiles torus_silhouettes(const Settings& settings);   ///< radii 16 and 8, 16 outer directions, 8 in the hole

/// |sum of weights - 1| at points within 3 voxels of the edge.
struct Unity {
    double rms = 0, mean_of_max = 0, max = 0;  ///< over all points; mean of each orientation's maximum; overall maximum
};
/// At planes of 24 orientations: edges known exactly, or estimated (and stored) from data of blur 0.7.
Unity plane_unity(const Settings& settings, bool estimated);
/// In pictures of planes with the same extinction on both sides: deviation from the picture of a uniform block.
Unity picture_unity(const Settings& settings);

/// Spheres with estimated edges: rms error of reconstructed two-tone data (1 inside, 0 outside).
struct SphereUnity {
    Unity unity;
    double raw = 0;         ///< sum of the weights inside
    double normalised = 0;  ///< the same divided by the sum of all weights
};
SphereUnity sphere_unity(const Settings& settings, double radius);

/// A plate of `thickness` voxels between two cavities, blur 0.5, the iso-value at half of its middle's value; 12
/// orientations. Face-on at 10 pixels per voxel, edge-on at 40.
struct Wall {
    double low = 0;        ///< smallest tau / mean tau, worst orientation
    double variation = 0;  ///< standard deviation / mean, averaged over the orientations
    double depth = 0;      ///< mean tau / thickness
    double rise = 0, location = 0;
    int missed = 0;
    std::vector<Evenness> faces;  ///< one per orientation
};
Wall wall(const Settings& settings, double thickness);

/// Optical depth of balls with blur .7 and extinction 1, summed over pictures from 8 directions, divided by their
/// volume.
double ball_matter(const Settings& settings, double radius);

}  // namespace edgesplat::test

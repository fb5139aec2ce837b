// How sharp, how well placed and how even edges come out, measured from pictures that the device renders. The program
// prints the figures, the tests hold them.
#pragma once

#include <string>
#include <vector>

#include "tests/properties/measuring.h"

namespace edgesplat::test {

/// A way to render that is compared with others.
struct Method {
    std::string name;
    Settings settings;
};

/// The default first; then plain splatting, the estimators, the paper's curve and the paper's own method.
std::vector<Method> compared_methods();

/// Planes seen edge-on at 24 random orientations, opacity, without the matter that is less than `cut_away` voxels from
/// the grid's outermost samples: where the plane meets the grid's border a kernel knows one of the two.
EdgeProfiles plane_edges(const Settings& settings, double cut_away);

/// Opaque solids, extinction 4 per voxel, on alpha: where it is one half, against the edge of the solid's projection
/// (the ray that just touches it). Positive location: the picture's solid is too large.
EdgeProfiles sphere_silhouettes(const Settings& settings);  ///< radius 9.3, 16 directions
EdgeProfiles torus_silhouettes(const Settings& settings);   ///< radii 16 and 8, 16 outer directions, 8 in the hole

/// |sum of weights - 1| at points within 3 voxels of the edge.
struct Unity {
    double rms = 0, mean_of_max = 0, max = 0;  ///< over all points; of each orientation's largest; of all
};
/// At planes of 24 orientations: edges known exactly, or estimated (and stored) from data of blur 0.7.
Unity plane_unity(const Settings& settings, bool estimated);
/// In pictures of planes whose both sides have the same extinction: deviation from the picture of a uniform block.
Unity picture_unity(const Settings& settings);

/// Spheres, estimated edges. Reconstruction of two-tone data (1 inside, 0 outside) against the truth, rms.
struct SphereUnity {
    Unity unity;
    double raw = 0;         ///< sum of the weights inside
    double normalised = 0;  ///< divided by the sum of all weights
};
SphereUnity sphere_unity(const Settings& settings, double radius);

/// A plate of `thickness` voxels between two cavities, blur 0.5, the iso-value at half of what its middle reaches; 12
/// orientations. Face-on at 10 pixels per voxel, edge-on at 40.
struct Wall {
    double low = 0;        ///< smallest tau over its mean, worst orientation
    double variation = 0;  ///< standard deviation over mean, mean of the orientations
    double depth = 0;      ///< mean tau over thickness
    double rise = 0, location = 0;
    int missed = 0;
    std::vector<Evenness> faces;  ///< by orientation
};
Wall wall(const Settings& settings, double thickness);

/// How much optical depth balls in blur .7 have, extinction 1, summed over pictures from 8 directions, over their
/// volume.
double ball_matter(const Settings& settings, double radius);

}  // namespace edgesplat::test

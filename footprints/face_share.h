// How much of a kernel the matter next to a face holds.
//
// Where matter is no thicker than a kernel the lattice has too few voxels in it, and the sum of their kernels falls
// short of 1. What it is in the mean, over all ways in which the lattice can lie, is the share of a kernel that the
// matter holds: so kernels are divided by that, and thin matter is as dense as thick.
#pragma once

#include <limits>

namespace edgesplat {

/// What a face encloses, by its quadric phi(x) = c + g.x + x'Hx / 2, |grad phi| = 1, n = grad phi at its foot point.
/// Lengths are voxels.
struct FaceBody {
    double bend = 0;    ///< n'Hn: where it is above 0 the quadric closes, 2 / bend further on
    double mean = 0;    ///< of the two principal curvatures
    double spread = 0;  ///< half their difference
    double thickness = std::numeric_limits<double>::infinity();  ///< of the wall
};

/// What bends less than that (the Frobenius norm of H, 1/voxel) and is no wall has room for all of a kernel.
inline constexpr double kThinBending = 0.1;

/// The integral of a kernel whose centre lies `depth` under the face over the matter that the face encloses: at most 1,
/// and no less than what a voxel has by itself in its centre.
double face_share(const FaceBody& body, double depth);

}  // namespace edgesplat

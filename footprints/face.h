// A face: the surface next to a voxel, and the kernel that it cuts.
//
// A face is the zero level of a quadric, phi(x) = c + g.x + x'Hx / 2, negative on the voxel's own side, |grad phi| = 1
// at its foot point. The kernel is nothing beyond it, and no nearer to it than `depth` it is sampled (design (12)):
// there x is moved along -grad phi until it lies that deep, so that where neighbours know one surface, all share one
// map and their sum is what it is inside. A wall has a second face, the level phi = -thickness. Along a ray everything
// that counts is quadratic in z, and vectors are left to the caller. Lengths are voxels, index space, relative to the
// voxel's centre.
#pragma once

#include <array>
#include <limits>
#include <span>

#include "footprints/footprint_integral.h"
#include "footprints/kernel.h"

namespace edgesplat {

/// c + z (b + z a).
struct Quadratic {
    double c = 0, b = 0, a = 0;
    double at(double z) const { return c + z * (b + z * a); }
};

/// What a ray x = p + z u, p its point nearest to the voxel's centre, u a unit vector, sees of a face.
struct FaceRay {
    double rho2 = 0;   ///< |p|^2
    Quadratic phi;     ///< at x
    Quadratic slope2;  ///< |grad phi|^2
    Quadratic along;   ///< x . grad phi
};

/// How a face cuts a kernel, whatever the ray.
struct FaceCut {
    double depth = 0.8;                                          ///< where it is sampled at least, > 0
    double bend = 0;                                             ///< n'Hn at the foot point: second derivative across
    double thickness = std::numeric_limits<double>::infinity();  ///< of the wall, > 0
    double reach = kKernelRadius;                                ///< of the cut kernel from the voxel's centre
};

/// How deep under a face kernels are sampled where there is room: most of the sum of kernels is there (.8 of a voxel
/// behind a lattice plane .82 at least, .966 in the mean), and what lies deeper than R + that is not drawn for the
/// face.
inline constexpr double kFaceDepth = 0.8;

/// `FaceCut` of a face with that bend and thickness whose foot point lies `distance` from the voxel's centre; `norm` is
/// the Frobenius norm of H, 1/voxel.
FaceCut face_cut(double distance, double bend, double norm, double thickness);

/// A piece of the ray on the own side of a face. It begins where the ray enters the matter, by the face or, of a wall,
/// by the face behind; or nowhere (-infinity).
struct FacePiece {
    double low = 0, high = 0;
    bool from_behind = false;
};

/// The pieces of a ray within the matter, in its order: none, one or two.
struct FacePieces {
    std::array<FacePiece, 2> piece;
    int count = 0;
};
FacePieces face_pieces(const FaceRay& ray, double thickness);

/// The cut kernel at the point z of a ray; whether it lies in the matter is the caller's to know.
double face_kernel(const FaceRay& ray, const FaceCut& cut, double z);

/// The integral of a cut kernel along a ray, per voxel, and where the matter was entered.
struct FaceFootprint {
    double integral = 0;
    double entry = 0;          ///< z of the light: where the ray enters, or where it comes within the kernel's reach
    bool from_behind = false;  ///< it enters by the wall's other face
};
/// By Gauss-Legendre with `nodes` nodes a piece.
FaceFootprint face_footprint(const FaceRay& ray, const FaceCut& cut, int nodes, const Slice& slice = {});

}  // namespace edgesplat

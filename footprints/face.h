// A face: the surface next to a voxel, and the kernel that it cuts.
//
// A face is the zero level of a quadric, phi(x) = c + g.x + x'Hx / 2, negative on the voxel's own side, |grad phi| = 1
// at its foot point. The kernel is nothing beyond it, and no nearer to it than `depth` it is sampled (design (12)):
// there x is moved against the face's normal until it lies that deep, so that where neighbours know one surface, all
// share one map and their sum is what it is inside. A wall has a second face, the level phi = -thickness. Along a ray
// everything that counts is quadratic in z, and vectors are left to the caller. There x is moved along the normal of
// the face where the ray meets it, on the way in or on the way out, whichever is nearer: kernels of one surface then
// share one map on one ray, and nothing of it is more than a plane. Lengths are voxels, index space, relative to the
// voxel's centre. At a crease another plane ends the matter: it cuts a kernel likewise, and x is moved along its
// normal, too, after it was moved along the face's. At a corner a third one ends the matter and moves nothing.
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

/// Where a quadric is met along a ray: low <= high.
struct FaceRoots {
    bool real = false;
    double low = 0, high = 0;
};

/// Where phi = -level. No root loses digits to cancellation; where phi is all but linear one lies out of every kernel's
/// reach.
FaceRoots face_roots(const Quadratic& phi, double level);

/// What a ray x = p + z u, p its point nearest to the voxel's centre, u a unit vector, sees of a face.
struct FaceRay {
    double rho2 = 0;    ///< |p|^2
    Quadratic phi;      ///< at x
    Quadratic slope2;   ///< |grad phi|^2
    double across = 0;  ///< p . grad phi at p
    double turn = 0;    ///< p . Hu
    struct Crease {
        double p = 0, u = 0;  ///< n . p, n . u
    };
    Crease crease;  ///< of the plane in the cut
    Crease corner;  ///< of a corner's third plane
};

/// How a face cuts a kernel, whatever the ray.
struct FaceCut {
    double depth = 0.8;                                          ///< where it is sampled at least, > 0
    double thickness = std::numeric_limits<double>::infinity();  ///< of the wall, > 0
    double reach = kKernelRadius;                                ///< of the cut kernel from the voxel's centre
    const Kernel* kernel = &kKernel;                             ///< that is cut
    /// Another plane that ends the matter; none at infinity.
    struct Crease {
        double distance = std::numeric_limits<double>::infinity();  ///< from the voxel's centre
        double facing = 0;                                          ///< cosine of its normal with the face's
    };
    Crease crease;
    double corner = std::numeric_limits<double>::infinity();  ///< distance of a corner's third plane; none at infinity
};

/// How deep under a face kernels of matter that hides what is behind it are sampled where there is room: most of the
/// sum of kernels is enough there (.8 of a voxel behind a lattice plane .86 at least, .98 in the mean). Where one sees
/// through matter they are sampled where they are, since voxels beside it carry it, too: the sum is 1 up to the face.
/// Faces further away than R + that cut nothing.
inline constexpr double kFaceDepth = 0.8;

/// No kernel reaches further from its voxel, whatever cuts it.
inline constexpr double kFaceFarthest = 3;

/// What lies deeper in a wall than this share of it shows the other face.
inline constexpr double kBesideOther = 0.8;

/// Nodes of a piece of such a kernel, likewise; one of the paper's profile has as many as the second.
inline constexpr int kFewNodes = 6, kManyNodes = 10;

/// `FaceCut` of a face of that thickness whose foot point lies `distance` from the voxel's centre; `bend` is n'Hn
/// there, `norm` the Frobenius norm of H, 1/voxel, `deepest` kFaceDepth or 0.
FaceCut face_cut(double distance, double bend, double norm, double thickness, double deepest = kFaceDepth,
                 const Kernel& kernel = kKernel);

/// Adds a plane that may cut the kernel, and by as much as it is moved along it lets the kernel reach further: no
/// further than the deepest face does, which costs edges that one sees through a little of their outermost matter.
/// `corner`: the distance of a third one beside it.
void add_crease(FaceCut& cut, const FaceCut::Crease& crease, double corner = std::numeric_limits<double>::infinity());

/// The plane that touches a face where a ray meets it, or where it is next to that within the kernel's reach: n . x
/// along the ray, and from which value on x is moved along n.
struct FacePlane {
    double p = 0, u = 0, level = std::numeric_limits<double>::infinity();
    double at(double z) const { return p + z * u; }
    /// Whether nothing is moved between two points of the ray.
    bool is_deep(double z, double other) const { return at(z) <= level && at(other) <= level; }
    /// |x|^2 of where a point of the ray is sampled, less rho2.
    double beyond(double z) const;
};

/// A piece of the ray on the own side of a face. It begins where the ray enters the matter, by the face or, of a wall,
/// by the face behind; or nowhere (at -1e9).
struct FacePiece {
    double low = 0, high = 0;
    int from_plane = 0, to_plane = 0;  ///< as FaceEnd::plane
    FacePlane entry, leave;
    /// The plane that the point z of the ray is sampled by: that of the nearer end.
    const FacePlane& plane(double z) const { return z > 0.5 * (low + high) ? leave : entry; }
};

/// An end of the ray's way through a kernel's matter: at a face, or where it comes within the kernel's reach.
struct FaceEnd {
    double z = 0;
    bool behind = false;  ///< the wall's other face, or within the reach, beside it
    int plane = 0;        ///< by the face (0), the crease's plane (1) or the corner's (2)
};

/// The integral of a cut kernel along a ray, per voxel, where the ray enters its matter first, and leaves it last.
struct FaceFootprint {
    double integral = 0;
    FaceEnd entry, leave;
};

/// Which of a ray's two pieces count. Of opaque matter what lies behind the first is not seen, and a kernel has most of
/// its matter in one.
enum class FacePieces { Both, Longer };

/// What a ray passes of a cut kernel: at most two pieces, in their order.
class FacePath {
  public:
    FacePath(const FaceRay& ray, const FaceCut& cut, FacePieces choice = FacePieces::Both);

    std::span<const FacePiece> pieces() const { return {pieces_.data(), count_}; }
    /// Of the ray within the cut kernel's reach: beyond it the kernel is 0.
    double half_chord() const { return half_chord_; }

    /// The cut kernel at the point z of the ray; 0 outside the matter.
    double kernel_at(double z) const;

    /// By Gauss-Legendre with `nodes` nodes a piece.
    FaceFootprint footprint(int nodes, const Slice& slice = {}) const;

  private:
    double overlap(const FacePiece& piece) const;
    /// The point z of the ray, held within the reach, as an end of its way.
    FaceEnd end_at(double z, int plane) const;
    /// |x|^2 of where the kernel is sampled for the point z of the ray.
    double sampled_at(const FacePiece& piece, double z) const;

    const Kernel* kernel_;
    double rho2_, half_chord_;
    FacePlane crease_;
    double facing_;  ///< of the crease with the face
    Quadratic phi_;
    double thickness_;
    std::array<FacePiece, 2> pieces_;
    std::size_t count_ = 0;
};

}  // namespace edgesplat

// A face: the surface next to a voxel, and the kernel that it cuts (docs/method/faces.md).
//
// A face is the zero level of a quadric, phi(x) = c + g.x + x'Hx / 2, negative on the voxel's own side, |grad phi| = 1
// at its foot point. Beyond the face the kernel is 0. A point x nearer to the face than `depth` is moved along the
// normal to that depth, and the kernel is sampled there. So neighbours that know one surface share one map, and the sum
// of their kernels is what it is inside the matter. On a ray, x is moved along the normal of the face where the ray
// enters the matter or leaves it, whichever is nearer. So kernels of one surface share one map on one ray, which has
// only planes in it.
//
// A wall has a second face, the level phi = -thickness. At a crease another plane cuts the kernel, too, and x is moved
// along its normal after the face's. At a corner a third plane cuts the kernel and moves nothing. Along a ray all these
// terms are quadratic in z; vectors are left to the caller. Lengths are voxels, index space, relative to the voxel's
// centre.
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

/// Intersections of a ray with a quadric: low <= high.
struct FaceRoots {
    bool real = false;
    double low = 0, high = 0;
};

/// Where phi = -level. No root loses digits to cancellation. If phi is almost linear, one root is out of every kernel's
/// reach.
FaceRoots face_roots(const Quadratic& phi, double level);

/// The values of a face along a ray x = p + z u; p is the ray's point nearest to the voxel's centre, u a unit vector.
struct FaceRay {
    double rho2 = 0;    ///< |p|^2
    Quadratic phi;      ///< at x
    Quadratic slope2;   ///< |grad phi|^2
    double across = 0;  ///< p . grad phi at p
    double turn = 0;    ///< p . Hu
    struct Crease {
        double p = 0, u = 0;  ///< n . p, n . u
    };
    Crease crease;  ///< of FaceCut::crease
    Crease corner;  ///< of a corner's third plane
};

/// How a face cuts a kernel, independent of the ray.
struct FaceCut {
    double depth = 0.8;  ///< smallest distance under the face at which it is sampled, >= 0
    double thickness = std::numeric_limits<double>::infinity();  ///< of the wall, > 0
    double reach = kKernelRadius;                                ///< of the cut kernel from the voxel's centre
    const Kernel* kernel = &kKernel;                             ///< the kernel that is cut
    /// A further plane that bounds the matter; none if the distance is infinite.
    struct Crease {
        double distance = std::numeric_limits<double>::infinity();  ///< from the voxel's centre
        double facing = 0;                                          ///< cosine of its normal with the face's
    };
    Crease crease;
    double corner = std::numeric_limits<double>::infinity();  ///< distance of a corner's third plane; none at infinity
};

/// FaceCut::depth under faces of opaque matter where there is room, voxels. There the sum of kernels is large enough:
/// .8 voxel behind a lattice plane at least .86, .98 in the mean. The depth is 0 in translucent matter: voxels beside
/// it emit splats of it, too, so the sum is 1 up to the face. Faces further away than R + kFaceDepth cut nothing.
inline constexpr double kFaceDepth = 0.8;

/// Upper bound of every cut kernel's reach, voxels.
inline constexpr double kFaceFarthest = 3;

/// A point deeper in a wall than this share of its thickness shows the other face.
inline constexpr double kBesideOther = 0.8;

/// Gauss-Legendre nodes per piece of a cut kernel: in opaque, and in translucent matter. A piece of the paper's profile
/// has kManyNodes.
inline constexpr int kFewNodes = 6, kManyNodes = 10;

/// The FaceCut of a face whose foot point lies `distance` from the voxel's centre. `bend`: n'Hn there; `norm`: the
/// Frobenius norm of H, 1/voxel; `deepest`: kFaceDepth or 0.
FaceCut face_cut(double distance, double bend, double norm, double thickness, double deepest = kFaceDepth,
                 const Kernel& kernel = kKernel);

/// Adds a crease's plane, which may cut the kernel. The reach grows by what points are moved along the plane's normal,
/// up to kFaceFarthest; this limit costs translucent edges a little of their outermost matter. `corner`: the distance
/// of a corner's third plane.
void add_crease(FaceCut& cut, const FaceCut::Crease& crease, double corner = std::numeric_limits<double>::infinity());

/// The face's tangent plane where a ray meets it, or at the end of the kernel's reach if the ray meets it further away:
/// n . x along the ray, and the value of n . x from which x is moved along n.
struct FacePlane {
    double p = 0, u = 0, level = std::numeric_limits<double>::infinity();
    double at(double z) const { return p + z * u; }
    /// Whether no point of the ray between these two is moved.
    bool is_deep(double z, double other) const { return at(z) <= level && at(other) <= level; }
    /// |x|^2 of the position at which a point of the ray is sampled, minus rho2.
    double beyond(double z) const;
};

/// A piece of the ray on the own side of a face. It begins where the ray enters the matter: through the face, or
/// through a wall's other face. If the ray never enters, it begins at -1e9.
struct FacePiece {
    double low = 0, high = 0;
    int from_plane = 0, to_plane = 0;  ///< as FaceEnd::plane
    FacePlane entry, leave;
    /// The plane by which the point z of the ray is moved: that of the nearer end.
    const FacePlane& plane(double z) const { return z > 0.5 * (low + high) ? leave : entry; }
};

/// An end of the ray's path through a kernel's matter: at a face, or at the end of the kernel's reach.
struct FaceEnd {
    double z = 0;
    bool behind = false;  ///< at a wall's other face, or beside it at the end of the reach
    int plane = 0;        ///< through the face (0), the crease's plane (1) or the corner's (2)
};

/// The integral of a cut kernel along a ray, 1/voxel^2, with the points where the ray first enters its matter and last
/// leaves it.
struct FaceFootprint {
    double integral = 0;
    FaceEnd entry, leave;
};

/// Which of a ray's two pieces count. In opaque matter the second piece is occluded, and a kernel has most of its
/// matter in one of them.
enum class FacePieces { Both, Longer };

/// The pieces of a cut kernel along a ray: at most two, in order.
class FacePath {
  public:
    FacePath(const FaceRay& ray, const FaceCut& cut, FacePieces choice = FacePieces::Both);

    std::span<const FacePiece> pieces() const { return {pieces_.data(), count_}; }
    /// Half the length of the ray within the cut kernel's reach; beyond it the kernel is 0.
    double half_chord() const { return half_chord_; }

    /// The cut kernel at the point z of the ray; 0 outside the matter.
    double kernel_at(double z) const;

    /// Integrates by Gauss-Legendre with `nodes` nodes per piece.
    FaceFootprint footprint(int nodes, const Slice& slice = {}) const;

  private:
    double overlap(const FacePiece& piece) const;
    /// The point z of the ray, clamped to the reach, as an end of its path.
    FaceEnd end_at(double z, int plane) const;
    /// |x|^2 of the position at which the kernel is sampled for the point z of the ray.
    double sampled_at(const FacePiece& piece, double z) const;

    const Kernel* kernel_;
    double rho2_, half_chord_;
    FacePlane crease_;
    double facing_;  ///< cosine between the normals of crease and face
    Quadratic phi_;
    double thickness_;
    std::array<FacePiece, 2> pieces_;
    std::size_t count_ = 0;
};

}  // namespace edgesplat

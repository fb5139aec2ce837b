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
#include <cstdint>
#include <limits>
#include <span>

#include "footprints/footprint_integral.h"
#include "footprints/kernel.h"

namespace edgesplat {

#define Real double
#define CONSTANT inline constexpr
#include "footprints/face_types.glsl"
#undef CONSTANT
#undef Real

/// No further planes.
inline constexpr FaceCrease kNoCrease = {0, 0, FACE_NOWHERE, 0, 0, 0, FACE_NOWHERE};

/// Gauss-Legendre nodes per piece of a cut kernel: in opaque, and in translucent matter. A piece of the paper's profile
/// has kManyNodes.
inline constexpr int kFewNodes = 6, kManyNodes = 10;

/// As in face.glsl.
double quadratic_at(const Quadratic& q, double z);
FaceRoots face_roots(const Quadratic& phi, double level);

/// The FaceCut of a face, as in face_cut.glsl; with_crease() adds a crease's plane at that distance.
FaceCut face_cut(double distance, double bend, double norm, double thickness, double deepest = FACE_DEPTH,
                 const Kernel& kernel = kKernel);
FaceCut with_crease(const FaceCut& cut, double distance, const Kernel& kernel = kKernel);

/// Which of a ray's two pieces count. In opaque matter the second piece is occluded, and a kernel has most of its
/// matter in one of them.
enum class FacePieces { Both, Longer };

/// A cut kernel along a ray.
class FacePath {
  public:
    FacePath(const FaceRay& ray, const FaceCut& cut, const FaceCrease& crease = kNoCrease,
             const Kernel& kernel = kKernel, FacePieces choice = FacePieces::Both);

    /// Its pieces: at most two, in order.
    std::span<const FacePiece> pieces() const { return {pieces_.data(), count_}; }
    /// Half the length of the ray within the cut kernel's reach; beyond it the kernel is 0.
    double half_chord() const { return half_chord_; }

    /// The cut kernel at the point z of the ray; 0 outside the matter.
    double kernel_at(double z) const;

    /// Integrates by Gauss-Legendre with `nodes` nodes per piece.
    FaceFootprint footprint(int nodes, const Slice& slice = {}) const;

  private:
    bool is_creased() const { return crease_.distance < FACE_NO_WALL; }

    FaceRay ray_;
    FaceCut cut_;
    FaceCrease crease_;
    const Kernel* kernel_;
    FacePieces choice_;
    double half_chord_ = 0;
    std::array<FacePiece, 2> pieces_{};
    std::size_t count_ = 0;
};

}  // namespace edgesplat

// The files of engine/geometry that ask for a splat's face, in double precision.
#pragma once

#include <cmath>

#include "engine/geometry/in_double.h"
#include "engine/reference/field_geometry.h"
#include "footprints/face.h"

namespace edgesplat::geometry {
// Like in_double.h: each source file has its own.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
namespace {  // NOLINT(google-build-namespaces)

/// A face and the kernel that it cuts, as those files ask for them.
struct FaceGeometry {
    explicit FaceGeometry(const Kernel& kernel = kKernel)
        : KERNEL_R(kernel.radius), KERNEL_R2(kernel.radius * kernel.radius), kernel_(kernel) {}

    Real KERNEL_R, KERNEL_R2;
    const Kernel& kernel_;

    FaceCut face_cut(Real distance, Real bend, Real norm, Real thickness, Real deepest) const {
        return edgesplat::face_cut(distance, bend, norm, thickness, deepest, kernel_);
    }
    FaceCut with_crease(const FaceCut& cut, Real distance) const {
        return edgesplat::with_crease(cut, distance, kernel_);
    }
    static FaceRoots face_roots(const Quadratic& phi, Real level) { return edgesplat::face_roots(phi, level); }
    static Real quadratic_at(const Quadratic& q, Real z) { return edgesplat::quadratic_at(q, z); }

#define INOUT(type) type&
#define IF_ANY(condition) if (condition)
#include "engine/geometry/face_form.glsl"
    FaceForm face_form{};
// After what it uses.
#include "engine/geometry/face_sight.glsl"
#include "engine/geometry/lit_path.glsl"
#undef IF_ANY
#undef INOUT

    /// Makes the edge's face, and the planes of its crease that cut the kernel, the one that is seen.
    void take(const reference::VoxelEdge& edge) {
        FaceTraits traits = {bending_of(edge.bending), no_plane(), NO_PLANE, edge.deepest};
        if (std::isfinite(edge.crease.D)) traits.crease = {edge.crease.n, edge.crease.D};
        const bool turned = glm::dot(glm::cross(edge.n, edge.crease.n), edge.corner.n) < 0;
        if (std::isfinite(edge.corner.D)) traits.corner = turned ? -edge.corner.D : edge.corner.D;
        const Edge e = edge_of(edge);
        const FaceCut cut = cut_of(e, traits, FACE_FARTHEST, true);
        face_form = face_form_of(e, traits, cut);
    }
};

}  // namespace
#pragma GCC diagnostic pop
}  // namespace edgesplat::geometry

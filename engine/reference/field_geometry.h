// The files of engine/geometry that ask for a field's samples, in double precision.
#pragma once

#include <span>

#include "engine/geometry/in_double.h"
#include "engine/reference/1_estimate_edges.h"
#include "engine/volume/labels.h"

namespace edgesplat::geometry {
// Like in_double.h: each source file has its own.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
namespace {  // NOLINT(google-build-namespaces)

Edge edge_of(const reference::VoxelEdge& edge) {
    const uint side = edge.upper ? EDGE_UPPER : EDGE_LOWER;
    return {edge.n, edge.D, edge.D2, edge.has_edge ? side : (edge.has_normal ? EDGE_NORMAL : EDGE_NONE)};
}

reference::VoxelEdge voxel_edge(const Edge& edge) {
    reference::VoxelEdge result;
    result.has_edge = edge.state >= EDGE_LOWER;
    result.has_normal = edge.state != EDGE_NONE;
    result.upper = edge.state == EDGE_UPPER;
    if (result.has_normal) result.n = edge.n;
    if (result.has_edge) result.D = edge.d;
    if (result.has_edge && edge.d2 < NO_PLANE) result.D2 = edge.d2;
    return result;
}

Bending bending_of(const glm::dmat3& h) {
    return {{h[0][0], h[1][1], h[2][2]}, {h[1][2], h[0][2], h[0][1]}};
}

glm::dmat3 matrix_of(const Bending& h) {
    return {h.diagonal.x, h.mixed.z, h.mixed.y, h.mixed.z, h.diagonal.y, h.mixed.x, h.mixed.y, h.mixed.x, h.diagonal.z};
}

/// A field and its materials, as those files ask for them. Outlives none of its parts.
struct FieldGeometry {
    FieldGeometry(const reference::Field& of, const reference::ScaledScene& materials,
                  std::span<const reference::VoxelEdge> found = {}, double deviation = 0, bool with_spline = true)
        : dims(of.dims),
          TWO_VALUES(materials.two_values ? 1 : 0),
          ISO_COUNT(static_cast<uint>(materials.iso.size())),
          field_(of),
          scene_(materials),
          edges_(found),
          noise_(deviation),
          cubic_(with_spline) {}

    ivec3 dims;
    uint TWO_VALUES, ISO_COUNT;
    const reference::Field& field_;
    const reference::ScaledScene& scene_;
    std::span<const reference::VoxelEdge> edges_;  ///< surfels; empty while they are looked for
    double noise_;                                 ///< scaled
    bool cubic_;                                   ///< surfels lie on the spline's surface

    Real voxel(ivec3 p) const { return field_.at(p); }
    static bool has_data(Real value) { return value >= 0; }
    uint material_of(Real value) const { return static_cast<uint>(scene_.material(value)); }
    uint material_at(ivec3 p) const { return material_of(voxel(p)); }
    Real lower_end(uint material) const { return scene_.lower(static_cast<int>(material)); }
    Real upper_end(uint material) const { return scene_.upper(static_cast<int>(material)); }
    static ivec3 block_origin() { return ivec3(0); }
    ivec3 volume_dims() const { return dims; }
    Real noise() const { return noise_; }
    vec3 field_gradient(ivec3 p) const { return reference::field_gradient(field_, p); }
    Real trilinear(ivec3 p, vec3 r) const { return sample(field_, vec3(p) + r); }
    vec4 bspline_slope(ivec3 p, vec3 r) const {
        const vec3 at = vec3(p) + r;
        return {spline_gradient(field_, at), sample(field_, at, true)};
    }
    vec4 field_slope(ivec3 p, vec3 r) const {
        const vec3 at = vec3(p) + r;
        return cubic_ ? bspline_slope(p, r) : vec4(point_gradient(field_, at), sample(field_, at));
    }

    struct StoredEdge {
        uint state;
        Real away;
        bool border;
        const reference::VoxelEdge* edge;
    };
    StoredEdge stored_edge(ivec3 p) const {
        const reference::VoxelEdge& edge = edges_[field_.offset(p)];
        return {geometry::edge_of(edge).state, std::abs(edge.D), edge.border, &edge};
    }
    uint label_number(ivec3 p) const { return label_near(*scene_.labels, dims, p); }
    bool label_votes(ivec3 p, uint material) const {
        return scene_.labels->on_scan ? material_at(p) == material : scene_.labels->at[field_.offset(p)] > 0;
    }
    static Edge edge_of(const StoredEdge& stored) { return geometry::edge_of(*stored.edge); }

#define INOUT(type) type&
#define IF_ANY(condition) if (condition)
#include "engine/geometry/values_around.glsl"
// After what it uses.
#include "engine/geometry/classified_value.glsl"
#include "engine/geometry/ends_beside.glsl"
#include "engine/geometry/find_edge.glsl"
#include "engine/geometry/seen_label.glsl"
#include "engine/geometry/surfel.glsl"
// After what it uses.
#include "engine/geometry/fit_face.glsl"
#include "engine/geometry/fit_surface.glsl"
#undef IF_ANY
#undef INOUT

    static reference::VoxelEdge voxel_edge(const Face& face) {
        reference::VoxelEdge edge = geometry::voxel_edge(face.edge);
        edge.bending = matrix_of(face.h);
        edge.mixed = face.mixed;
        edge.traced = face.traced;
        edge.steep = face.steep;
        if (face.creased) edge.crease = {face.crease.n, face.crease.away};
        if (face.creased && std::abs(face.corner) < NO_PLANE)
            edge.corner = reference::square_to(edge.n, edge.crease.n, std::abs(face.corner), face.corner < 0);
        return edge;
    }
};

}  // namespace
#pragma GCC diagnostic pop
}  // namespace edgesplat::geometry

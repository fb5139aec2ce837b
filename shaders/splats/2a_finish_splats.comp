// Gives each collected splat its edge, or the face that fits the surface around it. One invocation per splat of the
// compact list. docs/method.md, pass 2.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "shaders/drivers/if_any.glsl"
#include "shaders/shared/bindings.h"
#include "shaders/shared/scene_params.h"

layout(local_size_x = 64) in;
#include "shaders/common/groups.glsl"
layout(constant_id = SPEC_ESTIMATOR) const uint ESTIMATOR = 3u;
layout(constant_id = SPEC_FACES) const uint FACES = 0u;
layout(constant_id = SPEC_SURFACES) const uint SURFACES = 0u;
// Only between samples of two values is the shape of the field unknown: there creases are looked for, which the spline
// rounds.
layout(constant_id = SPEC_TWO_VALUES) const uint TWO_VALUES = 0u;
layout(binding = BIND_VOLUME, r32f) uniform readonly image3D volume;
layout(binding = BIND_COEFFICIENTS, r32f) uniform readonly image3D coefficients;
layout(binding = BIND_EDGES, rg32ui) uniform readonly uimage3D edges;
layout(binding = BIND_SCENE, scalar) uniform Scene { SceneParams scene; } params;

ivec3 dims;
#include "shaders/common/material.glsl"
#include "shaders/common/volume_sampling.glsl"

uint material_at(ivec3 p) { return material_of(voxel(p)); }

// The gradient at a voxel, of the field in which surfels are found.
vec3 field_gradient(ivec3 p) {
    if (ESTIMATOR == CUBIC) return bspline_slope(p, vec3(0.0)).xyz;
    return voxel_gradient(p);
}

ivec3 volume_dims() { return params.scene.volume_dims; }
float noise() { return params.scene.noise; }
#include "shaders/splats/crease_record.glsl"
#include "shaders/footprints/face_record.glsl"

struct StoredEdge {
    uvec2 code;
    uint state;
    float away;
    bool border;
};

StoredEdge stored_edge(ivec3 q) {
    uvec2 code = imageLoad(edges, q).xy;
    float away = abs(float(int(code.y << 16) >> 16)) * (EDGE_DISTANCE_UNIT / 32767.0);
    return StoredEdge(code, code.y >> 26 & 3u, away, (code.y & EDGE_BORDER) != 0u);
}

Edge edge_of(StoredEdge stored) { return unpack_edge(stored.code.x, stored.code.y); }
#include "engine/geometry/values_around.glsl"
#include "engine/geometry/surfel.glsl"
#include "engine/geometry/quadric.glsl"
#include "engine/geometry/fit_face.glsl"
#include "engine/geometry/surface_votes.glsl"
#include "engine/geometry/surface_check.glsl"
#include "engine/geometry/fit_surface.glsl"

uvec2 packed_traits(Face face) {
    if (face.creased) return pack_crease(face.crease, face.corner);
    return uvec2(pack_bending(face.h.diagonal) | (face.mixed ? FACE_MIXED : 0u), pack_bending(face.h.mixed) | (face.traced ? FACE_TRACED : 0u));
}

void main() {
    uint i = invocation_number();
    bool with_edge = false, with_crease = false, traced = false;
    IF_ANY(i < params.scene.list_count) {
        dims = params.scene.dims;
        i += params.scene.list_first;
        SplatsRef splats = SplatsRef(params.scene.splats);
        Splat splat = splats.at[i];
        uint nx = uint(params.scene.volume_dims.x), ny = uint(params.scene.volume_dims.y);
        ivec3 p = ivec3(splat.voxel % nx, splat.voxel / nx % ny, splat.voxel / nx / ny) - params.scene.block_origin;
        uint material = splat.edge >> 28;
        uvec2 code = imageLoad(edges, p).xy;
        Edge e = unpack_edge(code.x, code.y);
        e.d2 = 1e9;
        uint normal = code.x;
        if (SURFACES == 1u) {
            Face face = fit_surface(p, material);
            e = face.edge;
            normal = pack_normal(e.n);
            BendingsRef(params.scene.traits).at[i] = packed_traits(face);
            with_crease = face.creased;
            traced = face.traced;
        } else if (FACES == 1u) {
            Face face = finished_face(p, material, in_mask(params.scene.translucent_mask, material), params.scene.band);
            e = face.edge;
            normal = e.state == EDGE_NONE ? 0u : pack_normal(e.n);
            BendingsRef(params.scene.traits).at[i] = packed_traits(face);
            with_crease = face.creased;
        }
        with_edge = e.state >= EDGE_LOWER;
        splats.at[i] = Splat(splat.voxel, normal, (e.state == EDGE_NONE ? 0u : pack_edge(e)) | (material << 28));
    }
    uint edges_here = subgroupAdd(with_edge ? 1u : 0u), creases_here = subgroupAdd(with_crease ? 1u : 0u);
    uint traced_here = subgroupAdd(traced ? 1u : 0u);
    uint at = params.scene.edge_count_at;
    if (subgroupElect() && edges_here > 0u) atomicAdd(UintsRef(params.scene.run_offsets).at[at], edges_here);
    if (subgroupElect() && creases_here > 0u) atomicAdd(UintsRef(params.scene.run_offsets).at[at + 1u], creases_here);
    if (subgroupElect() && traced_here > 0u) atomicAdd(UintsRef(params.scene.run_offsets).at[at + 2u], traced_here);
}

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
#include "shaders/splats/fit_face.glsl"
// After what it uses.
#include "shaders/splats/fit_surface.glsl"

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
            // The voxel's own surfel is one point of the surface; the fitted face uses all surfels around and cuts the
            // kernel.
            Face face = fit_face(p, material);
            bool near = face.edge.state >= EDGE_LOWER && abs(face.edge.d) <= params.scene.band;
            bool through = in_mask(params.scene.translucent_mask, material);
            bool cut = near && (!through || abs(face.edge.d) < KERNEL_RADIUS);
            vec3 g = cut ? vec3(0.0) : field_gradient(p);
            float slope = length(g);
            Edge plain = Edge(-g / max(slope, 1e-30), 1e9, 1e9, slope >= GRADIENT_MIN ? EDGE_NORMAL : EDGE_NONE);
            // If the face is too far away to cut the kernel, the splat is lit with the face's normal at the voxel.
            vec3 under = (face.edge.state == EDGE_UPPER ? -1.0 : 1.0) * (face.edge.n - face.edge.d * bent(face.h, face.edge.n));
            vec3 lit = mix(under / max(length(under), 1e-6), plain.n, slope >= GRADIENT_MIN ? face.steep : 0.0);
            if (near && dot(lit, lit) > 1e-6) plain = Edge(normalize(lit), 1e9, 1e9, EDGE_NORMAL);
            if (material_at(p) != material) plain = Edge(vec3(0.0, 0.0, 1.0), CARRIES_NOTHING, 1e9, EDGE_LOWER);
            e = cut ? face.edge : plain;
            normal = e.state == EDGE_NONE ? 0u : pack_normal(e.n);
            BendingsRef(params.scene.traits).at[i] = cut ? packed_traits(face) : uvec2(0u);
            with_crease = cut && face.creased;
            traced = cut && face.traced;
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

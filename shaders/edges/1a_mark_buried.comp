// Marks voxels that opaque voxels enclose on all sides: erosion of the opaque voxels by a cube, one axis per dispatch.
// One invocation walks one line twice. Forward and backward it counts the opaque voxels since the last other voxel. A
// voxel stays marked if both runs are longer than the bury distance. Outside the volume nothing is opaque.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bindings.h"
#include "shaders/shared/scene_params.h"

layout(local_size_x = 64) in;
#include "shaders/common/groups.glsl"
layout(constant_id = SPEC_AXIS) const uint AXIS = 0u;
layout(binding = BIND_VOLUME, r32f) uniform readonly image3D volume;
layout(binding = BIND_BURIED, r8ui) uniform uimage3D buried;
layout(constant_id = SPEC_CLIP_KEEP) const uint CLIP_KEEP = 0u;
layout(constant_id = SPEC_CLIP_REMOVE) const uint CLIP_REMOVE = 0u;
layout(binding = BIND_SCENE, scalar) uniform Scene { SceneParams scene; } params;

#define ISO_VALUES params.scene.opaque_iso
#include "shaders/common/material.glsl"
#define CLIP_PARAMS params.scene
#include "shaders/common/clip.glsl"

bool opaque(ivec3 p) {
    if (AXIS != 0u) return imageLoad(buried, p).r != 0u;
    if (is_cut_away(vec3(p), 0.0)) return false;
    float value = imageLoad(volume, p).r;
    return value >= 0.0 && in_mask(params.scene.opaque_mask, material_of(value));
}

void main() {
    ivec3 dims = params.scene.dims;
    uint line = invocation_number();
    uvec3 n = uvec3(dims);
    ivec3 p, step;
    int count;
    if (AXIS == 0u) {
        p = ivec3(0, line % n.y, line / n.y);
        step = ivec3(1, 0, 0);
        count = line < n.y * n.z ? dims.x : 0;
    } else if (AXIS == 1u) {
        p = ivec3(line % n.x, 0, line / n.x);
        step = ivec3(0, 1, 0);
        count = line < n.x * n.z ? dims.y : 0;
    } else {
        p = ivec3(line % n.x, line / n.x, 0);
        step = ivec3(0, 0, 1);
        count = line < n.x * n.y ? dims.z : 0;
    }
    int reach = params.scene.bury_distance;
    int run = 0;
    for (int i = 0; i < count; ++i) {
        run = opaque(p) ? min(run + 1, 255) : 0;
        imageStore(buried, p, uvec4(run));
        p += step;
    }
    run = 0;
    for (int i = 0; i < count; ++i) {
        p -= step;
        int forward = int(imageLoad(buried, p).r);
        run = forward > 0 ? min(run + 1, 255) : 0;
        imageStore(buried, p, uvec4(forward > reach && run > reach ? 1u : 0u));
    }
}

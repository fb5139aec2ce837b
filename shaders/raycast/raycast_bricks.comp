// Finds the bricks that contain visible material: 0 for those, BRICK_FAR for transparent ones. docs/method.md, Ray
// caster.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/drivers/if_any.glsl"
#include "shaders/shared/raycast_params.h"
#include "shaders/shared/bindings.h"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
layout(constant_id = SPEC_TRANSFER) const uint TRANSFER = 0u;
layout(constant_id = SPEC_RAY_FILTER) const uint FILTER = FILTER_TRILINEAR;
layout(binding = BIND_VOLUME, r32f) uniform readonly image3D volume;
layout(binding = BIND_COEFFICIENTS, r32f) uniform readonly image3D coefficients;
layout(binding = BIND_BRICK_SCRATCH, r8ui) uniform writeonly uimage3D scratch;
layout(binding = BIND_RAYS, scalar) uniform Rays { SceneParams scene; RayParams rays; } params;
#include "shaders/common/material.glsl"
#include "shaders/common/transfer.glsl"

// A coefficient beyond a border is the linear extrapolation of the two before it.
float spline_coefficient(ivec3 p) {
    ivec3 last = params.scene.dims - 1, held = clamp(p, ivec3(0), last);
    float value = imageLoad(coefficients, held).r;
    IF_ANY(held != p) {
        ivec3 before = clamp(2 * held - p, ivec3(0), last);
        value = 0.0;
        for (int i = 0; i < 8; ++i) {
            bvec3 inner = bvec3(i & 1, i & 2, i & 4);
            vec3 w = mix(mix(vec3(1.0), vec3(2.0), notEqual(held, p)), mix(vec3(0.0), vec3(-1.0), notEqual(held, p)), inner);
            value += w.x * w.y * w.z * imageLoad(coefficients, mix(held, before, inner)).r;
        }
    }
    return value;
}

void main() {
    ivec3 brick = ivec3(gl_GlobalInvocationID), count = imageSize(scratch);
    if (any(greaterThanEqual(brick, count))) return;
    // A sample between the last voxel of a brick and the first of the next belongs to the former brick.
    ivec3 first = brick << BRICK_SHIFT, last = min(first + (1 << BRICK_SHIFT), params.scene.dims - 1);
    // A spline lies between the coefficients of the four voxels around it along each axis, up to rounding.
    if (FILTER == FILTER_CUBIC) {
        --first;
        ++last;
    }
    float low = 3e38, high = -3e38;
    for (int z = first.z; z <= last.z; ++z)
        for (int y = first.y; y <= last.y; ++y)
            for (int x = first.x; x <= last.x; ++x) {
                float value = 0.0, rounding = 0.0;
                if (FILTER == FILTER_CUBIC) {
                    value = spline_coefficient(ivec3(x, y, z));
                    rounding = 1e-6 * (1.0 + abs(value));
                } else {
                    value = imageLoad(volume, ivec3(x, y, z)).r;
                }
                low = min(low, value - rounding);
                high = max(high, value + rounding);
            }
    // A ray can meet every material and every value between low and high.
    uint materials = (2u << material_of(high)) - (1u << material_of(low));
    bool visible = (materials & params.scene.visible_mask) != 0u;
    if (TRANSFER == 1u) visible = transfer_between(TransferRef(params.scene.transfer), low, high).a > 0.0;
    imageStore(scratch, brick, uvec4(visible ? 0u : BRICK_FAR, 0u, 0u, 0u));
}

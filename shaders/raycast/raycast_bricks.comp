// Which bricks hold anything but transparent material: 0 for those, BRICK_FAR for the rest. docs/method.md, Ray caster.
#version 460
#extension GL_GOOGLE_include_directive : require
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

void main() {
    ivec3 brick = ivec3(gl_GlobalInvocationID), count = imageSize(scratch);
    if (any(greaterThanEqual(brick, count))) return;
    // A sample between the last voxel of a brick and the first of the next belongs to the former.
    ivec3 first = brick << BRICK_SHIFT, last = min(first + (1 << BRICK_SHIFT), params.scene.dims - 1);
    // A spline lies within the coefficients of the four voxels around along each axis, but for rounding.
    if (FILTER == FILTER_CUBIC) {
        first = max(first - 1, ivec3(0));
        last = min(last + 1, params.scene.dims - 1);
    }
    float low = 3e38, high = -3e38;
    for (int z = first.z; z <= last.z; ++z)
        for (int y = first.y; y <= last.y; ++y)
            for (int x = first.x; x <= last.x; ++x) {
                float value = 0.0, rounding = 0.0;
                if (FILTER == FILTER_CUBIC) {
                    value = imageLoad(coefficients, ivec3(x, y, z)).r;
                    rounding = 1e-6 * (1.0 + abs(value));
                } else {
                    value = imageLoad(volume, ivec3(x, y, z)).r;
                }
                low = min(low, value - rounding);
                high = max(high, value + rounding);
            }
    // Every material, and every value, between the two can be met on the way from one to the other.
    uint materials = (2u << material_of(high)) - (1u << material_of(low));
    bool visible = (materials & params.scene.visible_mask) != 0u;
    if (TRANSFER == 1u) visible = transfer_between(TransferRef(params.scene.transfer), low, high).a > 0.0;
    imageStore(scratch, brick, uvec4(visible ? 0u : BRICK_FAR, 0u, 0u, 0u));
}

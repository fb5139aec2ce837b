// For each brick, how far a ray may skip: the Chebyshev distance, in bricks, to the nearest brick that is not
// transparent. One axis per dispatch: min over j of max(|j|, distance so far at j). docs/method.md, Ray caster.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/raycast_params.h"
#include "shaders/shared/bindings.h"

layout(local_size_x = 8, local_size_y = 4, local_size_z = 2) in;
layout(constant_id = SPEC_AXIS) const uint AXIS = 0u;
layout(binding = BIND_BRICKS, r8ui) uniform uimage3D bricks;
layout(binding = BIND_BRICK_SCRATCH, r8ui) uniform uimage3D scratch;
layout(binding = BIND_RAYS, scalar) uniform Rays { SceneParams scene; RayParams rays; } params;

uint distance_at(ivec3 brick, ivec3 count) {
    if (any(lessThan(brick, ivec3(0))) || any(greaterThanEqual(brick, count))) return BRICK_FAR;
    return AXIS == 1u ? imageLoad(bricks, brick).r : imageLoad(scratch, brick).r;
}

void main() {
    ivec3 brick = ivec3(gl_GlobalInvocationID), count = imageSize(bricks);
    if (any(greaterThanEqual(brick, count))) return;
    ivec3 axis = ivec3(AXIS == 0u ? 1 : 0, AXIS == 1u ? 1 : 0, AXIS == 2u ? 1 : 0);
    uint nearest = BRICK_FAR;
    int reach = 0;
    for (; reach < int(BRICK_FAR); ++reach) {
        nearest = min(nearest, min(distance_at(brick - reach * axis, count), distance_at(brick + reach * axis, count)));
        if (nearest <= uint(reach)) break;
    }
    // x: scratch -> bricks, y: bricks -> scratch, z: scratch -> bricks.
    if (AXIS == 1u) imageStore(scratch, brick, uvec4(reach, 0u, 0u, 0u));
    else imageStore(bricks, brick, uvec4(reach, 0u, 0u, 0u));
}

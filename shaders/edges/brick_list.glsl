// Collects the wanted voxels of an 8^3 brick into a list without gaps. Then neighbouring invocations all have work;
// without the list, half of them would be idle at a surface. For workgroups of 64. Include after the shader has
// declared `bool wanted(ivec3 p)`.
#ifndef EDGESPLAT_BRICK_LIST_GLSL
#define EDGESPLAT_BRICK_LIST_GLSL
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require

const int BRICK_SIDE = int(BRICK);
shared uint brick_voxels[BRICK_SIDE * BRICK_SIDE * BRICK_SIDE];
shared uint brick_count;

ivec3 brick_voxel(uint i) { return ivec3(i & 7u, i >> 3 & 7u, i >> 6); }

// Lists the wanted voxels of the workgroup's brick, within the box from `low` up to `high`, in brick_voxels; returns
// their number. All invocations must call it.
uint list_brick(ivec3 low, ivec3 high) {
    if (gl_LocalInvocationIndex == 0u) brick_count = 0u;
    barrier();
    ivec3 first = low + BRICK_SIDE * ivec3(gl_WorkGroupID);
    for (uint i = gl_LocalInvocationIndex; i < uint(BRICK_SIDE * BRICK_SIDE * BRICK_SIDE); i += 64u) {
        ivec3 p = first + brick_voxel(i);
        bool in_list = all(lessThan(p, high)) && wanted(p);
        uvec4 others = subgroupBallot(in_list);
        uint place = 0u;
        if (subgroupElect()) place = atomicAdd(brick_count, subgroupBallotBitCount(others));
        place = subgroupBroadcastFirst(place) + subgroupBallotExclusiveBitCount(others);
        if (in_list) brick_voxels[place] = i;
    }
    barrier();
    return brick_count;
}

// The position of entry `i` of that list.
ivec3 listed_voxel(ivec3 low, uint i) { return low + BRICK_SIDE * ivec3(gl_WorkGroupID) + brick_voxel(brick_voxels[i]); }
#endif

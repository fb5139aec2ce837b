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

// Lists the wanted voxels of the brick at `first`, below `end`, in brick_voxels; returns their number. All invocations
// must call it.
uint list_brick(ivec3 first, ivec3 end) {
    if (gl_LocalInvocationIndex == 0u) brick_count = 0u;
    barrier();
    for (uint i = gl_LocalInvocationIndex; i < uint(BRICK_SIDE * BRICK_SIDE * BRICK_SIDE); i += 64u) {
        ivec3 p = first + brick_voxel(i);
        bool in_list = all(lessThan(p, end)) && wanted(p);
        uvec4 others = subgroupBallot(in_list);
        uint place = 0u;
        if (subgroupElect()) place = atomicAdd(brick_count, subgroupBallotBitCount(others));
        place = subgroupBroadcastFirst(place) + subgroupBallotExclusiveBitCount(others);
        if (in_list) brick_voxels[place] = i;
    }
    barrier();
    return brick_count;
}
#endif

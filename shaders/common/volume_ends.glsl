// Where a ray enters and leaves the volume along each axis, half a voxel beyond its outermost samples.
#ifndef EDGESPLAT_VOLUME_ENDS_GLSL
#define EDGESPLAT_VOLUME_ENDS_GLSL

struct VolumeEnds {
    vec3 near;
    vec3 far;
};

// From `from` along `way`, no part of which is 0. An axis of one voxel has no ends.
VolumeEnds volume_ends(vec3 from, vec3 way, ivec3 size) {
    vec3 a = (vec3(-0.5) - from) / way, b = (vec3(size) - 0.5 - from) / way;
    bvec3 endless = equal(size, ivec3(1));
    return VolumeEnds(mix(min(a, b), vec3(-1e9), endless), mix(max(a, b), vec3(1e9), endless));
}

// Out of the volume where the ray enters it, `low` along `way`: along one axis.
vec3 out_of_entry(VolumeEnds ends, float low, vec3 way) {
    bool x = ends.near.x >= low, y = !x && ends.near.y >= low;
    return -sign(way) * vec3(x, y, !x && !y);
}

// Parts of a direction, such that one can divide by them.
vec3 divisible(vec3 u) { return mix(u, vec3(1e-8), lessThan(abs(u), vec3(1e-8))); }
#endif

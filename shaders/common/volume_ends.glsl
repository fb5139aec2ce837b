// Where a ray enters and leaves the volume along each axis. The volume ends half a voxel beyond its outermost samples.
#ifndef EDGESPLAT_VOLUME_ENDS_GLSL
#define EDGESPLAT_VOLUME_ENDS_GLSL

struct VolumeEnds {
    vec3 near;
    vec3 far;
};

// For the ray from `from` along `way`; no component of `way` is 0.
VolumeEnds volume_ends(vec3 from, vec3 way, ivec3 size) {
    vec3 a = (vec3(-0.5) - from) / way, b = (vec3(size) - 0.5 - from) / way;
    return VolumeEnds(min(a, b), max(a, b));
}

// Unit vector along one axis that points out of the volume where the ray enters it (z = `low` along `way`).
vec3 out_of_entry(VolumeEnds ends, float low, vec3 way) {
    bool x = ends.near.x >= low, y = !x && ends.near.y >= low;
    return -sign(way) * vec3(x, y, !x && !y);
}

// Replaces components near 0 so that division by them is safe.
vec3 divisible(vec3 u) { return mix(u, vec3(1e-8), lessThan(abs(u), vec3(1e-8))); }
#endif

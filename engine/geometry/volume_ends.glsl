// Where a ray enters and leaves the volume along each axis. The volume ends half a voxel beyond its outermost samples.
// Written in the subset of GLSL that is C++, like surface_votes.glsl.
#ifndef EDGESPLAT_VOLUME_ENDS_GLSL
#define EDGESPLAT_VOLUME_ENDS_GLSL

struct VolumeEnds {
    vec3 near;
    vec3 far;
};

// For the ray from `from` along `way`; no component of `way` is 0.
VolumeEnds volume_ends(vec3 from, vec3 way, ivec3 size) {
    vec3 a = (vec3(-0.5) - from) / way;
    vec3 b = (vec3(size) - Real(0.5) - from) / way;
    VolumeEnds ends;
    ends.near = min(a, b);
    ends.far = max(a, b);
    return ends;
}

// The ray is in the volume from here to there, in units of `way`; not at all if the first is larger.
Real entry_of(VolumeEnds ends) { return max(ends.near.x, max(ends.near.y, ends.near.z)); }
Real exit_of(VolumeEnds ends) { return min(ends.far.x, min(ends.far.y, ends.far.z)); }

// Unit vectors along one axis that point out of the volume where the ray enters and leaves it.
vec3 out_of_entry(VolumeEnds ends, vec3 way) {
    Real at = entry_of(ends);
    bool x = ends.near.x >= at;
    bool y = !x && ends.near.y >= at;
    return -sign(way) * vec3(x, y, !x && !y);
}
vec3 out_of_exit(VolumeEnds ends, vec3 way) {
    Real at = exit_of(ends);
    bool x = ends.far.x <= at;
    bool y = !x && ends.far.y <= at;
    return sign(way) * vec3(x, y, !x && !y);
}

Real not_zero(Real v) { return abs(v) < 1e-8 ? Real(1e-8) : v; }
// Replaces components near 0 so that division by them is safe.
vec3 divisible(vec3 u) { return vec3(not_zero(u.x), not_zero(u.y), not_zero(u.z)); }
#endif

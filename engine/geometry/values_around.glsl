// The samples around a voxel. Written in the subset of GLSL that is C++. The includer declares `dims`, voxel(ivec3) and
// has_data(Real).
#ifndef EDGESPLAT_VALUES_AROUND_GLSL
#define EDGESPLAT_VALUES_AROUND_GLSL

bool is_in_volume(ivec3 q) { return all(greaterThanEqual(q, ivec3(0))) && all(lessThan(q, dims)); }

// The i-th of the 33 voxels: those next to it, and those two voxels along each axis.
ivec3 sample_around(int i) {
    ivec3 o = i < 27 ? ivec3(i % 3, i / 3 % 3, i / 9) - 1 : ivec3(0);
    if (i >= 27) o[(i - 27) >> 1] = (i & 1) == 1 ? -2 : 2;
    return o;
}

// Minimum and maximum of the samples around p. No surface within SURFEL_REACH passes between samples further away.
vec2 values_around(ivec3 p) {
    vec2 around = vec2(3e38, -3e38);
    for (int i = 0; i < 33; ++i) {
        Real value = voxel(clamp(p + sample_around(i), ivec3(0), dims - 1));
        around = vec2(min(around.x, value), max(around.y, value));
    }
    return around;
}

// The minimum of those samples with data; 3e38 if there is none.
Real least_data_around(ivec3 p) {
    Real least = 3e38;
    for (int i = 0; i < 33; ++i) {
        Real value = voxel(clamp(p + sample_around(i), ivec3(0), dims - 1));
        least = has_data(value) ? min(least, value) : least;
    }
    return least;
}
#endif

// The range of the samples around a voxel. The including shader declares `dims` and voxel(ivec3).
#ifndef EDGESPLAT_VALUES_AROUND_GLSL
#define EDGESPLAT_VALUES_AROUND_GLSL

// Minimum and maximum of the samples around p. No surface within SURFEL_REACH passes between samples further away.
vec2 values_around(ivec3 p) {
    vec2 around = vec2(3e38, -3e38);
    for (int i = 0; i < 33; ++i) {
        ivec3 o = i < 27 ? ivec3(i % 3, i / 3 % 3, i / 9) - 1 : ivec3(0);
        if (i >= 27) o[(i - 27) >> 1] = (i & 1) == 1 ? -2 : 2;
        float value = voxel(clamp(p + o, ivec3(0), dims - 1));
        around = vec2(min(around.x, value), max(around.y, value));
    }
    return around;
}

// The minimum of those samples with data; 3e38 if there is none.
float least_data_around(ivec3 p) {
    float least = 3e38;
    for (int i = 0; i < 33; ++i) {
        ivec3 o = i < 27 ? ivec3(i % 3, i / 3 % 3, i / 9) - 1 : ivec3(0);
        if (i >= 27) o[(i - 27) >> 1] = (i & 1) == 1 ? -2 : 2;
        float value = voxel(clamp(p + o, ivec3(0), dims - 1));
        least = has_data(value) ? min(least, value) : least;
    }
    return least;
}
#endif

// The scalar field between voxels, in index space, samples scaled to their range. docs/method.md, pass 1.
// The including shader declares `volume` and `coefficients` (r32f image3D) and the variable `dims`.
#include "shaders/common/trilinear.glsl"

vec4 bspline_weights(float t) {
    float s = 1.0 - t;
    return vec4(s * s * s, 3.0 * t * t * t - 6.0 * t * t + 4.0, 3.0 * s * s * s - 6.0 * s * s + 4.0, t * t * t) / 6.0;
}

// Mirror at the border, as the prefilter assumes.
ivec4 mirrored(int i, int n) {
    ivec4 m = abs(i + ivec4(-1, 0, 1, 2));
    return clamp(min(m, 2 * n - 2 - m), 0, n - 1);
}

float bspline(vec3 p) {
    p = clamp(p, vec3(0.0), vec3(dims - 1));
    vec3 c = floor(p);
    vec4 wx = bspline_weights(p.x - c.x), wy = bspline_weights(p.y - c.y), wz = bspline_weights(p.z - c.z);
    ivec4 x = mirrored(int(c.x), dims.x), y = mirrored(int(c.y), dims.y), z = mirrored(int(c.z), dims.z);
    float sum = 0.0;
    for (int k = 0; k < 4; ++k)
        for (int j = 0; j < 4; ++j) {
            float line = 0.0;
            for (int i = 0; i < 4; ++i)
                line += wx[i] * imageLoad(coefficients, ivec3(x[i], y[j], z[k])).r;
            sum += wy[j] * wz[k] * line;
        }
    return sum;
}

vec4 bspline_slopes(float t) {
    float s = 1.0 - t;
    return vec4(-0.5 * s * s, (1.5 * t - 2.0) * t, (2.0 - 1.5 * s) * s, 0.5 * t * t);
}

// (gradient, value) of the spline, at p from voxel `origin`.
vec4 bspline_slope(ivec3 origin, vec3 p) {
    p = clamp(p, vec3(-origin), vec3(dims - 1 - origin));
    vec3 c = floor(p), t = p - c;
    vec4 wx = bspline_weights(t.x), wy = bspline_weights(t.y), wz = bspline_weights(t.z);
    vec4 sx = bspline_slopes(t.x), sy = bspline_slopes(t.y), sz = bspline_slopes(t.z);
    ivec4 x = mirrored(origin.x + int(c.x), dims.x), y = mirrored(origin.y + int(c.y), dims.y), z = mirrored(origin.z + int(c.z), dims.z);
    vec4 sum = vec4(0.0);
    for (int k = 0; k < 4; ++k)
        for (int j = 0; j < 4; ++j) {
            vec2 line = vec2(0.0);
            for (int i = 0; i < 4; ++i)
                line += vec2(wx[i], sx[i]) * imageLoad(coefficients, ivec3(x[i], y[j], z[k])).r;
            sum += vec4(line.y * wy[j] * wz[k], line.x * sy[j] * wz[k], line.x * wy[j] * sz[k], line.x * wy[j] * wz[k]);
        }
    return sum;
}

// Central difference at a voxel, one-sided at the border, 0 along an axis of one voxel; value range per voxel.
vec3 voxel_gradient(ivec3 p) {
    ivec3 low = max(p - 1, ivec3(0)), high = min(p + 1, dims - 1);
    vec3 span = vec3(max(high - low, ivec3(1)));
    return vec3(voxel(ivec3(high.x, p.yz)) - voxel(ivec3(low.x, p.yz)),
                voxel(ivec3(p.x, high.y, p.z)) - voxel(ivec3(p.x, low.y, p.z)),
                voxel(ivec3(p.xy, high.z)) - voxel(ivec3(p.xy, low.z))) / span;
}

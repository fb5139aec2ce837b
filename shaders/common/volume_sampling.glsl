// The scalar field between voxels, in index space; samples are scaled to the value range. docs/method.md, pass 1.
// The including shader declares `volume` and `coefficients` (r32f image3D) and the variable `dims`.
#include "shaders/common/trilinear.glsl"

// Along one axis: the four coefficients around a point of the spline, and their weights for value and slope.
struct SplineTaps {
    ivec4 places;  // a place beyond a border has weight 0
    vec4 weights, slopes;
};

// A coefficient beyond a border is the linear extrapolation of the two before it. `cell`: 0 to n - 1.
vec4 within_border(vec4 w, int cell, int n) {
    w = cell == 0 ? vec4(0.0, w.y + 2.0 * w.x, w.z - w.x, w.w) : w;
    w = cell == n - 2 ? vec4(w.x, w.y - w.w, w.z + 2.0 * w.w, 0.0) : w;
    return cell == n - 1 ? vec4(w.x - w.z, w.y + 2.0 * w.z, 0.0, w.w) : w;
}

// At `origin` + p along an axis of n voxels, or at the outermost sample before it. Mirrors engine/volume/filters.h.
SplineTaps spline_taps(int origin, float p, int n) {
    float c = floor(p), t = p - c, s = 1.0 - t;
    int cell = origin + int(c);
    SplineTaps taps;
    taps.places = clamp(cell + ivec4(-1, 0, 1, 2), 0, n - 1);
    taps.weights = within_border(vec4(s * s * s, 3.0 * t * t * t - 6.0 * t * t + 4.0, 3.0 * s * s * s - 6.0 * s * s + 4.0, t * t * t) / 6.0, cell, n);
    taps.slopes = within_border(vec4(-0.5 * s * s, (1.5 * t - 2.0) * t, (2.0 - 1.5 * s) * s, 0.5 * t * t), cell, n);
    taps.weights = n == 1 ? vec4(0.0, 1.0, 0.0, 0.0) : taps.weights;
    taps.slopes = n == 1 ? vec4(0.0) : taps.slopes;
    return taps;
}

// The point nearest to `origin` + p between the outermost samples, relative to `origin`.
vec3 between_samples(ivec3 origin, vec3 p) { return clamp(p, vec3(-origin), vec3(dims - 1 - origin)); }

// (gradient, value) of the spline at voxel `origin` + p. Beyond the outermost samples it is linear: f(q) + grad f(q) .
// (p - q), with the point q between them that is nearest to p. Products of the axes' ways beyond would let matter grow at
// the box's edges.
vec4 bspline_slope(ivec3 origin, vec3 p) {
    vec3 q = between_samples(origin, p), way = p - q;
    SplineTaps x = spline_taps(origin.x, q.x, dims.x), y = spline_taps(origin.y, q.y, dims.y), z = spline_taps(origin.z, q.z, dims.z);
    vec4 sum = vec4(0.0);    // (gradient, value) at q
    vec3 mixed = vec3(0.0);  // second derivatives there: yz, xz, xy
    for (int k = 0; k < 4; ++k) {
        vec3 plane = vec3(0.0);  // derivatives by y, by x, by both
        for (int j = 0; j < 4; ++j) {
            vec2 line = vec2(0.0);
            for (int i = 0; i < 4; ++i)
                line += vec2(x.weights[i], x.slopes[i]) * imageLoad(coefficients, ivec3(x.places[i], y.places[j], z.places[k])).r;
            float wy = y.weights[j], wz = z.weights[k];
            sum += vec4(line.y * wy * wz, line.x * y.slopes[j] * wz, line.x * wy * z.slopes[k], line.x * wy * wz);
            plane += vec3(y.slopes[j], wy, y.slopes[j]) * line.xyy;
        }
        mixed += vec3(z.slopes[k], z.slopes[k], z.weights[k]) * plane;
    }
    vec3 turned = vec3(dot(mixed.yz, way.zy), dot(mixed.xz, way.zx), dot(mixed.xy, way.yx));
    return vec4(sum.xyz + turned, sum.w + dot(sum.xyz, way));
}

float bspline(vec3 p) { return bspline_slope(ivec3(0), p).w; }

// Central difference at a voxel, one-sided at the border, 0 along an axis of one voxel. Unit: value range per voxel.
vec3 voxel_gradient(ivec3 p) {
    ivec3 low = max(p - 1, ivec3(0)), high = min(p + 1, dims - 1);
    vec3 span = vec3(max(high - low, ivec3(1)));
    return vec3(voxel(ivec3(high.x, p.yz)) - voxel(ivec3(low.x, p.yz)),
                voxel(ivec3(p.x, high.y, p.z)) - voxel(ivec3(p.x, low.y, p.z)),
                voxel(ivec3(p.xy, high.z)) - voxel(ivec3(p.xy, low.z))) / span;
}

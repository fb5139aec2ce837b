// Rays from a surface to a light: the samples that find how much matter lies between. docs/method/light.md. Written in
// the subset of GLSL that is C++, like surface_votes.glsl.
#ifndef EDGESPLAT_LIGHT_RAY_GLSL
#define EDGESPLAT_LIGHT_RAY_GLSL
#include "engine/geometry/volume_ends.glsl"

const int SHADOW_RAYS = 4;

// Samples lie at start + k * step for first <= k < last, index space.
struct LightRay {
    vec3 start;
    vec3 step;
    int first;
    int last;
};

// Axes across the unit vector n and n itself (Duff et al. 2017, "Building an Orthonormal Basis, Revisited").
mat3 frame_of(vec3 n) {
    Real s = n.z >= 0.0 ? 1.0 : -1.0;
    Real a = -1.0 / (s + n.z);
    Real b = n.x * n.y * a;
    return mat3(vec3(1.0 + s * n.x * n.x * a, s * b, -s * n.x), vec3(b, s + n.y * n.y * a, -n.y), n);
}

// The k-th ray from a surface at p along u (unit, index space), at most `length` voxels long, through a volume of `dims`
// voxels. The rays start at the middles of the four quarters of a square voxel across u; together their samples are
// SHADOW_STEP / SHADOW_RAYS apart.
LightRay light_ray(vec3 p, vec3 u, Real length, int k, ivec3 dims) {
    mat3 axes = frame_of(u);
    Real a = (k & 1) == 0 ? -0.25 : 0.25;
    Real b = (k & 2) == 0 ? -0.25 : 0.25;
    LightRay ray;
    ray.step = SHADOW_STEP * u;
    ray.start = p + a * axes[0] + b * axes[1] + (Real(k) + 0.5) / Real(SHADOW_RAYS) * ray.step;
    VolumeEnds ends = volume_ends(ray.start, divisible(ray.step), dims);
    Real last = min(exit_of(ends), length / SHADOW_STEP);
    ray.first = int(ceil(clamp(entry_of(ends), Real(0.0), Real(1e6))));
    ray.last = int(ceil(clamp(last, Real(0.0), Real(1e6))));
    return ray;
}
#endif

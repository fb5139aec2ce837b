// The weight that makes the kernels around a voxel sum to one where its own kernel is largest. docs/method.md, pass 2.
// The including shader declares the uniform block `params.scene` and `edges` (rg32ui uimage3D).
#include "shaders/lib/edge_record.glsl"
#include "shaders/lib/kernel.glsl"

struct Band {
    float half_width;
    float strength;
    int faces;
};

Band band_of(Edge e) {
    float a = params.scene.half_width, k = params.scene.strength;
    float thickness = e.d + e.d2;
    bool wall = e.d2 < KERNEL_R + a;
    bool near = e.state >= EDGE_LOWER && abs(e.d) < KERNEL_R + a;
    // A wall under one voxel is splatted plainly.
    int faces = wall ? (thickness > 1.0 ? 2 : 0) : 1;
    return Band(wall ? wall_half_width(thickness, a) : a, wall ? wall_strength(thickness, k) : k, near ? faces : 0);
}

float kernel_at(Edge e, vec3 r) {
    Band band = band_of(e);
    float t = dot(r, e.n), moved = 0.0;
    if (band.faces >= 1) moved += edge_warp(t - e.d, band.half_width, band.strength) - (t - e.d);
    if (band.faces == 2) moved += edge_warp(t + e.d2, band.half_width, band.strength) - (t + e.d2);
    return kernel(dot(r, r) + moved * (2.0 * t + moved));
}

float kernel_weight(ivec3 p, ivec3 dims, Edge e) {
    Band band = band_of(e);
    float t = 0.0;
    if (band.faces >= 1) t += edge_warp_inverse(-e.d, band.half_width, band.strength) + e.d;
    if (band.faces == 2) t += edge_warp_inverse(e.d2, band.half_width, band.strength) - e.d2;
    vec3 x = vec3(p) + t * e.n;
    float sum = 0.0;
    // No kernel reaches further than 3 voxels.
    ivec3 low = max(ivec3(ceil(x - 3.0)), ivec3(0)), high = min(ivec3(floor(x + 3.0)), dims - 1);
    if (band.faces == 0) high.z = low.z - 1;
    for (int k = low.z; k <= high.z; ++k)
        for (int j = low.y; j <= high.y; ++j)
            for (int i = low.x; i <= high.x; ++i) {
                uvec2 code = imageLoad(edges, ivec3(i, j, k)).xy;
                sum += kernel_at(unpack_edge(code.x, code.y), x - vec3(i, j, k));
            }
    return sum > 0.0 ? clamp(1.0 / sum, 0.25, 4.0) : 1.0;
}

// Finds the surfel of a voxel by Newton's method on the field: the surface point whose normal passes through the voxel.
// docs/method.md, pass 1, faces. The including shader declares `dims`, voxel(ivec3) and field_slope(ivec3, vec3).

#include "shaders/drivers/if_any.glsl"
#include "shaders/edges/values_around.glsl"

Edge find_surfel(ivec3 p, float value, float low, float high, vec2 around) {
    Edge e = no_edge();
    bvec2 crossed = bvec2(around.x < low, around.y >= high);
    bool upper = crossed.y && (!crossed.x || high - value < value - low);
    float iso = upper ? high : low;
    vec3 at = vec3(0.0), n = vec3(0.0);  // relative to the voxel
    float off = 1.0;
    bool lost = !(crossed.x || crossed.y);
    for (int i = 0; i < SURFEL_STEPS && !lost; ++i) {
        vec4 slope_value = field_slope(p, at);
        float slope = length(slope_value.xyz);
        lost = !(slope >= GRADIENT_MIN) || length(at) > 3.0;
        n = slope_value.xyz / max(slope, 1e-30);
        off = (slope_value.w - iso) / max(slope, 1e-30);
        // The last step only evaluates the field.
        IF_ANY(i + 1 < SURFEL_STEPS && !lost) {
            at -= clamp(off, -0.6, 0.6) * n;
            // Moves tangentially towards the point whose normal passes through the voxel. The last steps only return to
            // the surface.
            at -= i >= 2 && i + 4 < SURFEL_STEPS ? 0.5 * (at - dot(at, n) * n) : vec3(0.0);
        }
    }
    n = upper ? n : -n;
    float d = dot(at, n);
    // The volume ends half a voxel beyond its outermost samples.
    bool inside = all(greaterThan(at, vec3(-p) - 0.5)) && all(lessThan(at, vec3(dims - 1 - p) + 0.5));
    bool found = !lost && abs(off) < 2e-3 && length(at - d * n) < 0.25 && abs(d) <= SURFEL_REACH && inside;
    if (found) e = Edge(n, d, 1e9, upper ? EDGE_UPPER : EDGE_LOWER);
    return e;
}

// The outward normal of the volume's border next to voxel p; 0 if p is not an outermost voxel. The border lies half a
// voxel beyond the outermost samples. On an axis of one voxel all voxels lie between two borders; it comes last, since
// the sum of the kernels fades out only towards the other borders.
vec3 border_beside(ivec3 p) {
    ivec3 at = p + params.scene.block_origin;
    bvec3 low = equal(at, ivec3(0)), high = equal(at, params.scene.volume_dims - 1);
    vec3 thin = vec3(0.0);
    for (int i = 0; i < 3; ++i)
        if (low[i] || high[i]) {
            vec3 n = vec3(0.0);
            n[i] = high[i] ? 1.0 : -1.0;
            if (!low[i] || !high[i]) return n;
            thin = n;
        }
    return thin;
}

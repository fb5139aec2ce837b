// Pass 1: the edge of a voxel, for every estimator. docs/method/1_estimate_edges.md. Written in the subset of GLSL that is
// C++. The includer declares `dims`, voxel(ivec3), field_slope(ivec3, vec3): (gradient, value) of the field at a voxel plus
// an offset, block_origin() and volume_dims(). Include after edge.glsl.
#ifndef EDGESPLAT_FIND_EDGE_GLSL
#define EDGESPLAT_FIND_EDGE_GLSL

// One step along the voxel's own gradient g (paper; Levoy 1988). [low, high): its material's interval; `band`: edges
// further away are none.
Edge extrapolated_edge(Real value, vec3 g, Real low, Real high, Real band) {
    Edge e = no_edge();
    Real slope = length(g);
    if (!(slope >= GRADIENT_MIN)) return e;
    vec3 n = g / slope;
    for (int end = 0; end < 2; ++end) {
        Real d = abs((end == 0 ? low : high) - value) / slope;
        bool nearer = d < e.d && d <= band;
        if (nearer) e.n = end == 0 ? -n : n;
        if (nearer) e.d = d;
        if (nearer) e.state = end == 0 ? EDGE_LOWER : EDGE_UPPER;
    }
    return e;
}

// The surfel of a voxel by Newton's method on the field: the surface point whose normal passes through the voxel.
// `around`: smallest and largest sample around it.
Edge find_surfel(ivec3 p, Real value, Real low, Real high, vec2 around) {
    Edge e = no_edge();
    bool below = around.x < low;
    bool above = around.y >= high;
    bool upper = above && (!below || high - value < value - low);
    Real iso = upper ? high : low;
    vec3 at = vec3(0.0);  // relative to the voxel
    vec3 n = vec3(0.0);
    Real off = 1.0;
    bool lost = !(below || above);
    for (int i = 0; i < SURFEL_STEPS && !lost; ++i) {
        vec4 slope_value = field_slope(p, at);
        Real slope = length(vec3(slope_value));
        lost = !(slope >= GRADIENT_MIN) || length(at) > 3.0;
        n = vec3(slope_value) / max(slope, 1e-30);
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
    Real d = dot(at, n);
    // The volume ends half a voxel beyond its outermost samples.
    bool inside = all(greaterThan(at, vec3(-p) - 0.5)) && all(lessThan(at, vec3(dims - 1 - p) + 0.5));
    bool found = !lost && abs(off) < 2e-3 && length(at - d * n) < 0.25 && abs(d) <= SURFEL_REACH && inside;
    if (found) e.n = n;
    if (found) e.d = d;
    if (found) e.state = upper ? EDGE_UPPER : EDGE_LOWER;
    return e;
}

// The outward normal of the volume's border next to voxel p; 0 if p is not an outermost voxel. The border lies half a
// voxel beyond the outermost samples. On an axis of one voxel all voxels lie between two borders; it comes last, since
// the sum of the kernels fades out only towards the other borders.
vec3 border_beside(ivec3 p) {
    ivec3 at = p + block_origin();
    ivec3 last = volume_dims() - 1;
    vec3 thin = vec3(0.0);
    for (int i = 0; i < 3; ++i) {
        bool low = at[i] == 0;
        bool high = at[i] == last[i];
        if (!low && !high) continue;
        vec3 n = vec3(0.0);
        n[i] = high ? 1.0 : -1.0;
        if (!low || !high) return n;
        thin = n;
    }
    return thin;
}

// Whether the border ends the matter of a voxel nearer than its edge does.
bool is_cut_by_border(Edge e, vec3 out_of) { return dot(out_of, out_of) > 0.0 && (e.state < EDGE_LOWER || abs(e.d) > 0.5); }

Edge border_edge(vec3 out_of) {
    Edge e = {out_of, 0.5, 1e9, EDGE_LOWER};
    return e;
}
#endif

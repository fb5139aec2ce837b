// The face of a surface splat: one quadric fitted to the surfels around, kept if it agrees with the field. Else the planes
// of a crease; else rays search the field wherever the face's error, which is kept in place of the second distance, shows
// (5_trace_faces). docs/method/surfaces.md. Written in the subset of GLSL that is C++. The includer declares, besides what
// fit_face.glsl needs, bspline_slope(ivec3, vec3): (gradient, value) of the spline, and noise(): standard deviation of the
// samples' noise. Include after fit_face.glsl and surface_check.glsl.
#ifndef EDGESPLAT_FIT_SURFACE_GLSL
#define EDGESPLAT_FIT_SURFACE_GLSL

// The number of axes along which matter ends on both sides of the voxel: 1 in a sheet, 2 in a rod, 3 in a speck. No foot
// point lies on its far side.
int thin_axes(ivec3 p, uint material) {
    int axes = 0;
    for (int axis = 0; axis < 3; ++axis) {
        ivec3 o = ivec3(axis == 0, axis == 1, axis == 2);
        axes += is_matter_at(p + o, material) || is_matter_at(p - o, material) ? 0 : 1;
    }
    return axes;
}

// The face of voxel p of the material, beside which matter ends (ends_beside).
Face fit_surface(ivec3 p, uint material) {
    Face face = plain_face(no_edge());
    face.edge.d = 0.0;
    face.edge.state = EDGE_LOWER;
    vec3 middle = vec3(0.0);
    vec3 n = vec3(0.0, 0.0, 1.0);
    Real nearest = KERNEL_RADIUS;
    uint state = EDGE_LOWER;
    bool found = false;
    // Its own surfel bounds the search.
    Surfel own_surfel = surfel_at(p, p, material, 0.0);
    Real bound = KERNEL_RADIUS;
    if (own_surfel.there && !own_surfel.border) bound = length(own_surfel.at) + 1e-3;
    for (int i = 0; i < 125; ++i) {
        ivec3 o = around_at(i);
        Surfel s = surfel_at(p, p + o, material, length(vec3(o)) - min(nearest, bound));
        bool nearer = s.there && !s.border && length(s.at) < nearest - 1e-4;
        found = found || nearer;
        nearest = nearer ? length(s.at) : nearest;
        middle = nearer ? s.at : middle;
        n = nearer ? s.n : n;
        state = nearer ? s.state : state;
    }
    bool kept = false;
    const bool two_values = TWO_VALUES == 1u;
    IF_ANY(found) {
        Moments sums = no_moments();
        ivec3 around = voxel_near(p, middle);
        for (int i = 0; i < 125; ++i) {
            ivec3 q = around + around_at(i);
            Surfel s = surfel_at(p, q, material, length(vec3(q - p) - middle) - SURFACE_FIT);
            vec3 r = s.at - middle;
            Real w = s.there && !s.border && dot(s.n, n) > 0.0 ? max(1.0 - dot(r, r) * (1.0 / (SURFACE_FIT * SURFACE_FIT)), 0.0) : 0.0;
            IF_ANY(w > 0.0) add_surfel(sums, r, s.n, w * w);
        }
        Quadric q = quadric_of(sums);
        Foot foot = foot_of(q, -middle, vec3(0.0));
        bool real_foot = is_foot(q, foot.at, foot.slope, SURFACE_FIT);
        Real scale = 1.0 / max(length(foot.slope), 0.3);
        vec3 up = foot.slope / max(length(foot.slope), 1e-6);
        SurfaceSplat own = {scale * quadric_at(q, -middle), scale * quadric_slope(q, -middle), scaled(q.h, scale), middle + foot.at,
                            SURFACE_REACH};
        bool upper = state == EDGE_UPPER;
        Real iso = upper ? upper_end(material) : lower_end(max(material, 1u));
        SurfaceCheck check = no_check();
        IF_ANY(real_foot) {
            for (int k = 0; k < SURFACE_CHECKS; ++k) {
                vec3 at = checked_point(own, up, k);
                vec4 field = bspline_slope(p, at);
                vec3 slope = vec3(field);
                check_point(check, own, at, field.w - iso, upper ? -slope : slope);
            }
        }
        Real wrong = 0.0;
        Real least = 1e9;
        Real most = -1e9;
        for (int i = 0; i < 27; ++i) {
            ivec3 o = sample_around(i);
            Real value = voxel(clamp(p + o, ivec3(0), dims - 1));
            least = min(least, value);
            most = max(most, value);
            wrong = max(wrong, contradiction(own, vec3(o), is_matter_at(p + o, material)));
        }
        int thin = thin_axes(p, material);
        bool agrees = is_verified(check, noise(), most - least) && dot(own.foot, up) > -0.05 &&
                      wrong <= SURFACE_SIDE + moved_by_noise(check.steep, noise());
        // Between samples of only two values the field says nothing.
        kept = real_foot && thin == 0 && (two_values || agrees);
        Real error = max(max(error_of(check), wrong), thin == 1 ? SURFACE_SHEET : Real(0.0));
        if (real_foot) face.h = own.h;
        face.edge.n = real_foot ? up : n;
        face.edge.d = dot(real_foot ? own.foot : middle, face.edge.n);
        face.edge.d2 = real_foot && thin < 2 ? error : 1e9;
        face.edge.state = state;
        // Planes go further than the field, which rounds sharp edges.
        if (two_values) {
            Face planes = fit_face(p, material);
            if (planes.creased) face = planes;
        }
    }
    face.traced = !face.creased && !kept;
    return face;
}
#endif

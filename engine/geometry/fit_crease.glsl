// Fits a crease: up to three planes that bound the matter beside a splat where no quadric fits. docs/method/faces.md, 7.
// Included by fit_face.glsl.
#ifndef EDGESPLAT_FIT_CREASE_GLSL
#define EDGESPLAT_FIT_CREASE_GLSL

// No array: lavapipe 22.3 read array elements in a struct incorrectly when a loop indexed them.
struct CreaseFit {
    bool found;
    Plane first;  // the nearest
    Plane second;
    Plane third;  // NO_PLANE: there are only two planes
};

// The state of the search: voxel p, and its nearest surfel at `middle` with the normal n.
struct CreaseSight {
    ivec3 p;
    uint material;
    vec3 middle;
    vec3 n;
    uint state;
};

Real crease_weight(Surfel s, vec3 middle, uint state) {
    vec3 r = s.at - middle;
    Real w = max(1.0 - dot(r, r) / (CREASE_RADIUS * CREASE_RADIUS), 0.0);
    return s.there && !s.border && s.state == state ? w * w : 0.0;
}

// Among the surfels so far, the normal that is least similar to given ones; 0 if all are similar to one of them.
struct Different {
    vec3 n;
    Real like;
};

Different none_different(Real like) {
    Different most = {vec3(0.0), like};
    return most;
}

// The first of equally different normals is kept, independent of rounding.
void see_different(INOUT(Different) most, Surfel s, vec3 middle, uint state, Real like) {
    bool better = crease_weight(s, middle, state) > 0.02 && like < most.like - 1e-4;
    most.like = better ? like : most.like;
    most.n = better ? s.n : most.n;
}

// True for a surfel on the rounded transition between two planes, relative to the normal n. It belongs to neither
// plane.
bool is_rounding(vec3 n, vec3 other) {
    Real like = dot(n, other);
    return like > CREASE_ROUNDED && like < CREASE_ALIKE;
}

vec3 most_different(CreaseSight sight, vec3 a, vec3 b) {
    ivec3 around = voxel_near(sight.p, sight.middle);
    Different most = none_different(CREASE_TURNED);
    for (int i = 0; i < 125; ++i) {
        Surfel s = surfel_at(sight.p, around + around_at(i), sight.material, 0.0);
        bool rounding = is_rounding(sight.n, s.n);
        see_different(most, s, sight.middle, sight.state, rounding ? 1.0 : max(dot(s.n, a), dot(s.n, b)));
    }
    return most.n;
}

struct PlaneFit {
    vec3 n;  // 0: none
    vec3 place;
};

PlaneFit fit_plane(CreaseSight sight, vec3 seed) {
    ivec3 around = voxel_near(sight.p, sight.middle);
    PlaneFit fit = {seed, vec3(0.0)};
    for (int step = 0; step < CREASE_STEPS; ++step) {
        vec3 normals = vec3(0.0);
        vec3 places = vec3(0.0);
        mat3 spread = mat3(0.0);
        Real sum = 0.0;
        for (int i = 0; i < 125; ++i) {
            Surfel s = surfel_at(sight.p, around + around_at(i), sight.material, 0.0);
            Real w = crease_weight(s, sight.middle, sight.state) * max(dot(s.n, fit.n) - CREASE_ALIKE, 0.0) / (1.0 - CREASE_ALIKE);
            normals += w * s.n;
            places += w * s.at;
            spread += w * outerProduct(s.at, s.at);
            sum += w;
        }
        fit.place = places / max(sum, 1e-9);
        // The spline's normals are tilted beside creases, since it rounds them; positions are more reliable.
        mat3 about = spread / max(sum, 1e-9) - outerProduct(fit.place, fit.place) + mat3(CREASE_SPREAD);
        normals = inverse(about) * normals;
        fit.n = sum > 0.05 ? normalize(normals) : vec3(0.0);
    }
    return fit;
}

// Whether the plane of one fit cuts off the points of the other. The matter must lie inside all planes; at a hollow
// crease it does not. Planes that face away from each other belong to a wall.
bool cuts_other(PlaneFit fit, PlaneFit other) {
    return dot(fit.n, other.place - fit.place) > -CREASE_BEHIND || dot(fit.n, other.n) < -0.5;
}

Plane plane_of(PlaneFit fit) {
    Plane plane = {fit.n, dot(fit.n, fit.place)};
    if (!(dot(fit.n, fit.n) > 0.0)) plane = no_plane();
    return plane;
}

// Sorts two planes, the nearer first.
void order_planes(INOUT(Plane) a, INOUT(Plane) b) {
    bool nearer = b.away < a.away - 1e-4;
    Plane other = b;
    if (nearer) b = a;
    if (nearer) a = other;
}

// `a`: the normal that is least similar to that of the surfel at `middle`.
CreaseFit fit_crease(CreaseSight sight, vec3 a) {
    CreaseFit found = {false, no_plane(), no_plane(), no_plane()};
    // If all normals are similar, as almost everywhere, the search ends here.
    IF_ANY(dot(a, a) > 0.0) {
        vec3 b = most_different(sight, a, a);
        vec3 c = most_different(sight, a, b);
        bool third = dot(c, c) > 0.0;
        PlaneFit one = fit_plane(sight, a);
        PlaneFit two = fit_plane(sight, b);
        PlaneFit three = {vec3(0.0), vec3(0.0)};
        IF_ANY(third) three = fit_plane(sight, c);
        bool some = dot(b, b) > 0.0 && dot(one.n, one.n) > 0.0 && dot(two.n, two.n) > 0.0;
        some = some && !cuts_other(one, two) && !cuts_other(two, one) && (!third || dot(three.n, three.n) > 0.0);
        bool cut = cuts_other(one, three) || cuts_other(two, three) || cuts_other(three, one) || cuts_other(three, two);
        found.found = some && !(third && cut);
        found.first = plane_of(one);
        found.second = plane_of(two);
        found.third = plane_of(three);
        order_planes(found.first, found.second);
        order_planes(found.second, found.third);
        order_planes(found.first, found.second);
    }
    return found;
}

// The third plane for Face::corner, if it is perpendicular to the first two and passes in front of the voxel.
Real corner_of(CreaseFit crease) {
    vec3 across = normalize(cross(crease.first.n, crease.second.n));
    Real like = dot(across, crease.third.n);
    bool kept = abs(like) > CORNER_SQUARE && crease.third.away > 0.0 && crease.third.away < CREASE_REACH;
    return kept ? sign(like) * crease.third.away : NO_PLANE;
}

// Distance of a point from the planes' intersection region; positive outside.
Real off_crease(CreaseFit crease, vec3 r) {
    Real two = max(dot(crease.first.n, r) - crease.first.away, dot(crease.second.n, r) - crease.second.away);
    return max(two, dot(crease.third.n, r) - crease.third.away);
}

// Sum of squared distances: of the surfels around, weighted, and of the samples on the wrong side. Surfels inside the
// planes are no errors, since the spline has rounded them.
Real crease_error(CreaseSight sight, CreaseFit crease) {
    Real error = 0.0;
    ivec3 p = sight.p;
    ivec3 around = voxel_near(p, sight.middle);
    for (int i = 0; i < 125; ++i) {
        Surfel s = surfel_at(p, around + around_at(i), sight.material, 0.0);
        Real off = max(off_crease(crease, s.at), 0.0);
        error += s.there && !s.border ? surfel_weight(s.at - sight.middle, sight.n, s.n) * off * off : 0.0;
    }
    for (int i = 0; i < 27; ++i) {
        ivec3 o = sample_around(i);
        bool inside = is_matter_at(p + o, sight.material);
        Real off = off_crease(crease, vec3(o));
        off = min(max(inside ? off : -off, 0.0), 1.0);
        error += off * off;
    }
    return error;
}

// Whether the planes, which leave the squared error `left`, are better than the best quadric with the error `best`. At a
// blunt angle, a narrow ridge looks like two planes. Planes also count if they leave almost nothing.
bool explains_more(CreaseFit crease, Real left, Real best) {
    bool blunt = dot(crease.first.n, crease.second.n) > CREASE_BLUNT;
    return left < (blunt ? CREASE_BLUNT_LEFT : FIT_OWN) * best || (!blunt && left < CREASE_ROUNDED_LEFT);
}
#endif

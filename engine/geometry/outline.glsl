// Finds the outline that passes a pixel: the distance across the ray from the pixel's centre to the point where the
// face, or the edge of a crease, turns away. docs/method/smoothing.md, Outlines. Written in the subset of GLSL that is C++.
// The includer declares rate_across(vec3 gradient, Real depth): change of a function with this gradient, at a depth (mm),
// from a pixel to its neighbours to the right and below. Include after face_sight.glsl.
#ifndef EDGESPLAT_OUTLINE_GLSL
#define EDGESPLAT_OUTLINE_GLSL

// Where a function is `level` at a pixel's centre, and changes by `rate` per pixel; matter lies where it is negative.
struct PassingOutline {
    bool there;
    Real level;
    vec2 rate;
};

// A splat along the pixel's ray.
struct OutlinedSplat {
    FaceSight sight;
    FaceCrease crease;
    Real ahead;        // distance along u from the eye to the ray's point nearest to the voxel, voxels
    Real depth_along;  // mm of depth per voxel along the ray
    Real tau;          // optical depth of the splat on the ray
};

// A splat that is too faint, or too far from the ray, knows no outline.
bool knows_outline(OutlinedSplat splat, Real level, Real z) {
    Real distance2 = splat.sight.ray.rho2 + z * z;
    return level < 0.0 ? splat.tau > OUTLINE_TAU && distance2 < OUTLINE_FAR2 : distance2 < OUTLINE_NEAR2;
}

// Whether the point z of the ray lies inside the third plane of a corner.
bool inside_corner(OutlinedSplat splat, Real z) { return splat.crease.corner_p + z * splat.crease.corner_u < splat.crease.corner_distance; }

// Outline of the face, where phi has its minimum on the ray; of a wall's other face, where phi has its maximum.
PassingOutline outline_of_face(OutlinedSplat splat, bool creases) {
    Quadratic phi = splat.sight.ray.phi;
    bool opens = phi.a >= 0.0;
    Real bend = max(abs(phi.a), FACE_STRAIGHT);
    Real side = opens ? 1.0 : -1.0;
    Real z = -0.5 * phi.b / (side * bend);
    Real depth = (splat.ahead + z) * splat.depth_along;
    PassingOutline found;
    found.level = side * (quadratic_at(phi, z) + (opens ? Real(0.0) : face_form.cut.thickness));
    bool there = (opens || face_form.cut.thickness < FACE_NO_WALL) && depth > 0.0;
    if (creases) there = there && splat.crease.p + z * splat.crease.u < splat.crease.distance && inside_corner(splat, z);
    found.rate = side * rate_across(splat.sight.slope + z * splat.sight.turn, depth);
    found.there = there && knows_outline(splat, found.level, z);
    return found;
}

// Outline of the edge between face and crease, where the ray's piece between them shrinks to length 0.
PassingOutline outline_of_crease(OutlinedSplat splat) {
    FaceCrease crease = splat.crease;
    bool leaves = crease.u > 0.0;  // the ray leaves the matter through the crease's plane
    Real side = leaves ? 1.0 : -1.0;
    FaceRoots roots = face_roots(splat.sight.ray.phi, 0.0);
    Real at_face = (splat.sight.ray.phi.a >= 0.0) == leaves ? roots.low : roots.high;
    Real u = side * max(abs(crease.u), FACE_STRAIGHT);
    Real at_crease = (crease.distance - crease.p) / u;
    Real z = 0.5 * (at_face + at_crease);
    Real depth = (splat.ahead + z) * splat.depth_along;
    Real along = splat.sight.ray.phi.b + 2.0 * at_face * splat.sight.ray.phi.a;
    PassingOutline found;
    found.level = side * (at_face - at_crease);
    found.rate = side * (rate_across(face_form.crease.n, depth) / u - rate_across(splat.sight.slope + at_face * splat.sight.turn, depth) / along);
    bool there = roots.real && crease.distance < FACE_NO_WALL && depth > 0.0 && along * u < 0.0 && inside_corner(splat, z);
    found.there = there && knows_outline(splat, found.level, z);
    return found;
}
#endif

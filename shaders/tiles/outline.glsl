// Finds the outline that passes a pixel: the distance across the ray from the pixel's centre to the point where the
// face, or the edge of a crease, turns away. The including shader declares the variable
// `face_form` and the uniform block `params.frame`. docs/method/smoothing.md, Outlines.
#ifndef EDGESPLAT_OUTLINE_GLSL
#define EDGESPLAT_OUTLINE_GLSL
#include "shaders/splats/face_sight.glsl"
#include "shaders/splats/outline_word.glsl"

// A splat along the pixel's ray.
struct OutlinedSplat {
    FaceSight sight;
    FaceCrease crease;
    float ahead;        // distance along u from the eye to the ray's point nearest to the voxel, voxels
    float depth_along;  // mm of depth per voxel along the ray
    float tau;          // optical depth of the splat on the ray
};

uint splat_outline(OutlinedSplat splat, float level, vec2 rate, float z) {
    float distance2 = splat.sight.ray.rho2 + z * z;
    bool knows = level < 0.0 ? splat.tau > OUTLINE_TAU && distance2 < OUTLINE_FAR2 : distance2 < OUTLINE_NEAR2;
    return knows ? outline_word(level, rate) : NO_OUTLINE;
}

// Whether the point z of the ray lies inside the third plane of a corner.
bool inside_corner(OutlinedSplat splat, float z) { return splat.crease.corner_p + z * splat.crease.corner_u < splat.crease.corner_distance; }

// Outline of the face, where phi has its minimum on the ray; of a wall's other face, where phi has its maximum.
uint outline_of_face(OutlinedSplat splat) {
    Quadratic phi = splat.sight.ray.phi;
    bool opens = phi.a >= 0.0;
    float bend = max(abs(phi.a), FACE_STRAIGHT), side = opens ? 1.0 : -1.0;
    float z = -0.5 * phi.b / (side * bend), depth = (splat.ahead + z) * splat.depth_along;
    float level = side * (quadratic_at(phi, z) + (opens ? 0.0 : face_form.cut.thickness));
    bool there = (opens || face_form.cut.thickness < FACE_NO_WALL) && depth > 0.0;
    if (CREASES == 1u) there = there && splat.crease.p + z * splat.crease.u < splat.crease.distance && inside_corner(splat, z);
    vec2 rate = side * rate_across(splat.sight.slope + z * splat.sight.turn, depth);
    return there ? splat_outline(splat, level, rate, z) : NO_OUTLINE;
}

// Outline of the edge between face and crease, where the ray's piece between them shrinks to length 0.
uint outline_of_crease(OutlinedSplat splat) {
    FaceCrease crease = splat.crease;
    bool leaves = crease.u > 0.0;  // the ray leaves the matter through the crease's plane
    float side = leaves ? 1.0 : -1.0;
    FaceRoots roots = face_roots(splat.sight.ray.phi, 0.0);
    float at_face = (splat.sight.ray.phi.a >= 0.0) == leaves ? roots.low : roots.high;
    float u = side * max(abs(crease.u), FACE_STRAIGHT), at_crease = (crease.distance - crease.p) / u;
    float z = 0.5 * (at_face + at_crease), depth = (splat.ahead + z) * splat.depth_along;
    float along = splat.sight.ray.phi.b + 2.0 * at_face * splat.sight.ray.phi.a;
    vec2 rate = side * (rate_across(face_form.crease.xyz, depth) / u - rate_across(splat.sight.slope + at_face * splat.sight.turn, depth) / along);
    bool there = roots.real && crease.distance < FACE_NO_WALL && depth > 0.0 && along * u < 0.0 && inside_corner(splat, z);
    return there ? splat_outline(splat, side * (at_face - at_crease), rate, z) : NO_OUTLINE;
}

// Outline of a splat with a face and with the optical depth `tau` on the ray; other arguments as in splat_value().
uint outline_of(vec3 p, vec3 u, float ahead, float tau) {
    OutlinedSplat splat;
    splat.sight = face_sight(p, u);
    if (CREASES == 1u) splat.crease = crease_seen(p, u);
    splat.ahead = ahead;
    splat.depth_along = dot(params.frame.view_z, u);
    splat.tau = tau;
    uint word = outline_of_face(splat);
    if (CREASES == 1u) word = min(word, outline_of_crease(splat));
    return word;
}
#endif

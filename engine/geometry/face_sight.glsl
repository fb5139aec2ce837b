// A splat's face, and the planes of its crease, along a ray. Written in the subset of GLSL that is C++. The includer declares
// the variable `face_form` (face_form.glsl).
#ifndef EDGESPLAT_FACE_SIGHT_GLSL
#define EDGESPLAT_FACE_SIGHT_GLSL

// The splat's face along a ray. z is measured from p, the ray's point nearest to the voxel.
struct FaceSight {
    FaceRay ray;
    vec3 slope;  // grad phi at p
    vec3 turn;   // derivative of grad phi along u
};

FaceSight face_sight(vec3 p, vec3 u) {
    vec3 hp = bent(face_form.h, p);
    vec3 hu = bent(face_form.h, u);
    vec3 slope = face_form.slope + hp;
    FaceSight sight;
    sight.ray.rho2 = dot(p, p);
    sight.ray.phi.c = face_form.value + 0.5 * dot(face_form.slope + slope, p);
    sight.ray.phi.b = dot(slope, u);
    sight.ray.phi.a = 0.5 * dot(u, hu);
    sight.ray.slope2.c = dot(slope, slope);
    sight.ray.slope2.b = 2.0 * dot(slope, hu);
    sight.ray.slope2.a = dot(hu, hu);
    sight.ray.across = dot(p, slope);
    sight.ray.turn = dot(p, hu);
    sight.slope = slope;
    sight.turn = hu;
    return sight;
}

// Normal of a corner's third plane, not unit; faces of creases are plane.
vec3 corner_normal() { return sign(face_form.corner) * cross(face_form.slope, face_form.crease.n); }

FaceCrease crease_seen(vec3 p, vec3 u) {
    Plane plane = face_form.crease;
    FaceCrease seen;
    seen.p = dot(plane.n, p);
    seen.u = dot(plane.n, u);
    seen.distance = plane.away;
    seen.facing = dot(plane.n, face_form.slope);
    seen.corner_p = 0.0;
    seen.corner_u = 0.0;
    seen.corner_distance = FACE_NOWHERE;
    IF_ANY(abs(face_form.corner) < FACE_NO_WALL) {
        vec3 third = normalize(corner_normal());
        seen.corner_p = dot(third, p);
        seen.corner_u = dot(third, u);
        seen.corner_distance = abs(face_form.corner);
    }
    return seen;
}

// The normal at the end of a ray's path through a kernel's matter, out of it, not unit.
vec3 normal_at(FaceSight sight, FaceEnd end, bool creases) {
    vec3 slope = end.side * (sight.slope + end.z * sight.turn);
    if (creases) slope = end.plane == 1 ? face_form.crease.n : (end.plane == 2 ? corner_normal() : slope);
    return slope;
}
#endif

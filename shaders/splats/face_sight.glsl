// A splat's face, and the planes of its crease, along a ray. The including shader declares the variable `face_form`.
#ifndef EDGESPLAT_FACE_SIGHT_GLSL
#define EDGESPLAT_FACE_SIGHT_GLSL
#include "shaders/drivers/if_any.glsl"
#include "shaders/footprints/face_form.glsl"
#include "shaders/footprints/face.glsl"

// The splat's face along a ray. z is measured from p, the ray's point nearest to the voxel.
struct FaceSight {
    FaceRay ray;
    vec3 slope;  // grad phi at p
    vec3 turn;   // derivative of grad phi along u
};

FaceSight face_sight(vec3 p, vec3 u) {
    vec3 hp = bent(face_form.h, p), hu = bent(face_form.h, u);
    vec3 slope = face_form.slope + hp;
    FaceRay ray;
    ray.rho2 = dot(p, p);
    ray.phi = Quadratic(face_form.value + 0.5 * dot(face_form.slope + slope, p), dot(slope, u), 0.5 * dot(u, hu));
    ray.slope2 = Quadratic(dot(slope, slope), 2.0 * dot(slope, hu), dot(hu, hu));
    ray.across = dot(p, slope);
    ray.turn = dot(p, hu);
    return FaceSight(ray, slope, hu);
}

// Normal of a corner's third plane, not unit; faces of creases are plane.
vec3 corner_normal() { return sign(face_form.corner) * cross(face_form.slope, face_form.crease.xyz); }

FaceCrease crease_seen(vec3 p, vec3 u) {
    vec4 plane = face_form.crease;
    FaceCrease seen = FaceCrease(dot(plane.xyz, p), dot(plane.xyz, u), plane.w, dot(plane.xyz, face_form.slope), 0.0, 0.0, FACE_NOWHERE);
    IF_ANY(abs(face_form.corner) < FACE_NO_WALL) {
        vec3 third = normalize(corner_normal());
        seen.corner_p = dot(third, p);
        seen.corner_u = dot(third, u);
        seen.corner_distance = abs(face_form.corner);
    }
    return seen;
}
#endif

// Whether a fitted face agrees with the field that it was fitted to. docs/method.md, Surface splats; design (15). Written
// in the subset of GLSL that is C++. Include after surface_votes.glsl.
#ifndef EDGESPLAT_SURFACE_CHECK_GLSL
#define EDGESPLAT_SURFACE_CHECK_GLSL

const int SURFACE_CHECKS = 9;

// The k-th point of a face with the normal n at its foot, relative to the voxel: eight around the foot, then the foot.
vec3 checked_point(SurfaceSplat face, vec3 n, int k) {
    vec3 other = abs(n.x) < 0.6 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
    vec3 a = normalize(cross(n, other));
    vec3 b = cross(n, a);
    Real angle = 0.785398163 * Real(k);
    vec3 at = face.foot;
    if (k < 8) at = at + SURFACE_RING * (cos(angle) * a + sin(angle) * b);
    for (int i = 0; i < 4; ++i) {
        vec3 slope = face.slope + bent(face.h, at);
        Real value = face.value + 0.5 * dot(face.slope + slope, at);
        Real steep = max(length(slope), 0.2);
        at = at - clamp(value / steep, -0.5, 0.5) / steep * slope;
    }
    return at;
}

// What the checked points found so far.
struct SurfaceCheck {
    Real away;    // largest distance of the field's surface, voxels
    Real turned;  // largest angle between the normals, radians
    Real steep;   // the field's slope at the foot
};

SurfaceCheck no_check() {
    SurfaceCheck check;
    check.away = 0.0;
    check.turned = 0.0;
    check.steep = 0.0;
    return check;
}

// Compares the face at one of its points with the field there: `off` its value minus the iso-value, `slope` its
// gradient, into the matter.
void check_point(INOUT(SurfaceCheck) check, SurfaceSplat face, vec3 at, Real off, vec3 slope) {
    Real steep = max(length(slope), 1e-6);
    vec3 n = face.slope + bent(face.h, at);
    Real alike = -dot(n, slope) / (steep * max(length(n), 1e-6));
    check.away = max(check.away, abs(off) / steep);
    check.turned = max(check.turned, acos(clamp(alike, -1.0, 1.0)));
    check.steep = steep;
}

// How far the noise moves the surface where the field is that steep, voxels.
Real moved_by_noise(Real steep, Real noise) { return SURFACE_NOISE * noise / max(steep, 1e-6); }

// How far the spline's ripples move a surface, voxels, about: too few samples lie on an edge that is steep for what it
// rises. `rise`: of the samples around.
Real moved_by_ripples(Real steep, Real rise) {
    Real beyond = max(steep / max(rise, 1e-6) - SURFACE_SMOOTH, 0.0);
    return SURFACE_RIPPLE * beyond * beyond;
}

// Whether the face lies no further from the field than the spline's ripples and the noise explain.
bool is_verified(SurfaceCheck check, Real noise, Real rise) {
    Real moved = moved_by_noise(check.steep, noise);
    Real allowed = SURFACE_ERROR + moved_by_ripples(check.steep, rise) + min(moved, 0.5);
    return check.away <= allowed && check.turned <= SURFACE_TURN + moved;
}

// How far a sample at r near the face lies on its wrong side; 0 on the right one.
Real contradiction(SurfaceSplat face, vec3 r, bool matter) {
    vec3 slope = face.slope + bent(face.h, r);
    Real off = (face.value + 0.5 * dot(face.slope + slope, r)) / max(length(slope), 0.2);
    vec3 from_foot = r - face.foot;
    Real wrong = max(matter ? off : -off, 0.0);
    return dot(from_foot, from_foot) < 2.25 ? wrong : 0.0;
}

// How far the face may lie from the field's surface, voxels, or how far its light may seem to.
Real error_of(SurfaceCheck check) { return max(check.away, (check.turned - SURFACE_TURN) * SURFACE_RING); }
#endif

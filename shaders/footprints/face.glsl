// Integrates kernels that a face cuts along a ray: the float32 mirror of footprints/face.h (same names, same
// equations). Include after shaders/footprints/footprint.glsl. Written in the subset of GLSL that is also C++.
#ifndef EDGESPLAT_FACE_GLSL
#define EDGESPLAT_FACE_GLSL

#include "shaders/footprints/face_cut.glsl"

const float FACE_STRAIGHT = 1e-6;
const float BESIDE_OTHER = 0.8;  // kBesideOther
const float FACE_NOWHERE = 1e9;  // a position along a ray, voxels: beyond every kernel's reach

// c + b z + a z^2.
struct Quadratic {
    float c;
    float b;
    float a;
};
float quadratic_at(Quadratic q, float z) { return q.c + z * (q.b + z * q.a); }

struct FaceRay {
    float rho2;
    Quadratic phi;
    Quadratic slope2;
    float across;  // p . grad phi at p
    float turn;    // p . Hu
};

// The point where a ray enters or leaves a kernel's matter.
struct FaceEnd {
    float z;
    float side;   // -1: at the wall's other face, or beside it; else 1
    int plane;    // at the face (0), the crease's plane (1) or the corner's (2)
};

struct FaceFootprint {
    float integral;
    FaceEnd entry;
    FaceEnd leave;
};

struct FaceRoots {
    bool real;
    float low;
    float high;
};

FaceRoots face_roots(Quadratic phi, float level) {
    float c = phi.c + level;
    float a = abs(phi.a) < FACE_STRAIGHT ? (phi.a < 0.0 ? -FACE_STRAIGHT : FACE_STRAIGHT) : phi.a;
    float disc = phi.b * phi.b - 4.0 * a * c;
    float root = sqrt(max(disc, 0.0));
    float q = -0.5 * (phi.b + (phi.b < 0.0 ? -root : root));
    float far = q / a;
    float near = q != 0.0 ? c / q : far;
    FaceRoots r;
    r.real = disc >= 0.0;
    r.low = min(near, far);
    r.high = max(near, far);
    return r;
}

// The tangent plane of a face at the point where a ray meets it, or where the ray is nearest to it within the kernel's
// reach. p = n.p, u = n.u, level: x is moved along n if n.x exceeds it.
struct FacePlane {
    float p;
    float u;
    float level;
};

// Of the face phi = -level. `side` -1: the matter lies where phi is larger.
FacePlane face_plane(FaceRay ray, float depth, float z, float level, float side) {
    float inverse = side * inversesqrt(max(quadratic_at(ray.slope2, z), 1e-8));
    FacePlane plane;
    plane.p = (ray.across + z * ray.turn) * inverse;
    plane.u = (ray.phi.b + 2.0 * z * ray.phi.a) * inverse;
    plane.level = plane.p + z * plane.u - (quadratic_at(ray.phi, z) + level) * inverse - depth;
    return plane;
}

// True if no point of the ray between the two ends is moved, because both ends are deep.
bool is_deep(FacePlane plane, float z, float other) { return plane.p + max(z * plane.u, other * plane.u) <= plane.level; }

// Where a ray enters and leaves the half-spaces of the crease's planes, and through which plane.
struct CreaseEnds {
    float low;
    float high;
    int low_plane;
    int high_plane;
};

CreaseEnds plane_ends(float p, float u, float distance, int plane) {
    float way = abs(u) < FACE_STRAIGHT ? (u < 0.0 ? -FACE_STRAIGHT : FACE_STRAIGHT) : u;
    float z = (distance - p) / way;
    CreaseEnds ends;
    ends.low = way < 0.0 ? z : -FACE_NOWHERE;
    ends.high = way < 0.0 ? FACE_NOWHERE : z;
    ends.low_plane = plane;
    ends.high_plane = plane;
    return ends;
}

CreaseEnds crease_ends(FaceCrease crease) {
    CreaseEnds ends = plane_ends(crease.p, crease.u, crease.distance, 1);
    CreaseEnds corner = plane_ends(crease.corner_p, crease.corner_u, crease.corner_distance, 2);
    ends.low_plane = corner.low > ends.low ? 2 : 1;
    ends.high_plane = corner.high < ends.high ? 2 : 1;
    ends.low = max(ends.low, corner.low);
    ends.high = min(ends.high, corner.high);
    return ends;
}

// The end of the ray's piece at z. A point deeper in a wall than BESIDE_OTHER of its thickness shows the other face.
FaceEnd face_end(FaceRay ray, FaceCut cut, float z, int plane) {
    return FaceEnd(z, plane == 0 && quadratic_at(ray.phi, z) < -BESIDE_OTHER * cut.thickness ? -1.0 : 1.0, plane);
}

// Integral of the kernel between two ends of the ray's piece in the matter. Near each end, the tangent plane there
// moves the points. `from_behind`, `to_behind`: the ray enters or leaves through the wall's other face.
float face_piece(FaceRay ray, FaceCut cut, bool creased, FaceCrease crease, CreaseEnds ends, float from, float to, bool from_behind,
                 bool to_behind, float half_chord, Slice slice) {
    // A ray that meets no face is nearest to it where phi has its extremum.
    bool meets = from > -FACE_NOWHERE || to < FACE_NOWHERE;
    float turn = -0.5 * ray.phi.b / min(ray.phi.a, -FACE_STRAIGHT);
    FacePlane entry = face_plane(ray, cut.depth, clamp(meets ? from : turn, -half_chord, half_chord), from_behind ? cut.thickness : 0.0,
                                 from_behind ? -1.0 : 1.0);
    FacePlane leave = face_plane(ray, cut.depth, clamp(meets ? to : turn, -half_chord, half_chord), to_behind ? cut.thickness : 0.0,
                                 to_behind ? -1.0 : 1.0);
    float plain = sqrt(max(KERNEL_R2 - ray.rho2, 0.0));
    float core = 1.0 - ray.rho2 * KERNEL_INVERSE_R2;
    FacePlane edge;
    if (creased) {
        edge.p = crease.p;
        edge.u = crease.u;
        edge.level = crease.distance - cut.depth;
        from = max(from, ends.low);
        to = max(min(to, ends.high), from);
    }
    float middle = 0.5 * (from + to);
    // Deeper than all moved points, nothing lies beyond the plain kernel's reach. In a wall, this must be true up to
    // half_chord, because its other face may be tilted.
    float far = cut.thickness < FACE_NO_WALL ? half_chord : plain;
    bool deep_before = is_deep(entry, -plain, -far) && (!creased || is_deep(edge, -plain, -far));
    bool deep_behind = is_deep(leave, plain, far) && (!creased || is_deep(edge, plain, far));
    float begin = max(max(from, deep_before ? -plain : -half_chord), slice.low);
    float len = max(min(min(to, deep_behind ? plain : half_chord), slice.high) - begin, 0.0);
    float sum = 0.0;
    for (int k = 0; k < FOOTPRINT_NODES; ++k) {
        float z = begin + len * FOOTPRINT_NODE[FOOTPRINT_RULE + k];
        bool late = z > middle;
        FacePlane plane;
        plane.p = late ? leave.p : entry.p;
        plane.u = late ? leave.u : entry.u;
        plane.level = late ? leave.level : entry.level;
        float t = plane.p + z * plane.u;
        float held = min(t, plane.level);
        float beyond = z * z - t * t + held * held;
        if (creased) {
            float across = edge.p + z * edge.u + (held - t) * crease.facing;
            float kept = min(across, edge.level);
            beyond += kept * kept - across * across;
            // A face is curved: a point moved along two normals may seem to be nearer than the voxel.
            beyond = max(beyond, -ray.rho2);
        }
        sum += FOOTPRINT_WEIGHT[FOOTPRINT_RULE + k] * kernel_at(core - beyond * KERNEL_INVERSE_R2);
    }
    return len * sum;
}

// `creased` is a constant at every call, so that scenes without creases compile to no code for them. No loop depends on
// the splat, because lavapipe would keep no variable in a register across such a loop. The including shader declares
// FACE_PIECES: 2, or 1 if all matter is opaque; then only the longer of two pieces counts.
FaceFootprint footprint_face(FaceRay ray, FaceCut cut, bool creased, FaceCrease crease, Slice slice) {
    float half_chord = sqrt(max(cut.reach2 - ray.rho2, 0.0));
    bool wall = cut.thickness < FACE_NO_WALL;
    // Along the ray, phi has a minimum (opens) or a maximum between its zeros.
    bool opens = ray.phi.a >= 0.0;
    FaceRoots face = face_roots(ray.phi, 0.0);
    FaceRoots behind = face_roots(ray.phi, cut.thickness);
    behind.real = behind.real && wall;
    bool everywhere = !opens && !wall;
    bool has_outer = everywhere || (opens ? face.real : behind.real);
    float outer_low = everywhere ? -FACE_NOWHERE : (opens ? face.low : behind.low);
    float outer_high = everywhere ? FACE_NOWHERE : (opens ? face.high : behind.high);
    bool has_inner = opens ? behind.real : face.real;
    float inner_low = has_inner ? (opens ? behind.low : face.low) : outer_high;
    float inner_high = has_inner ? (opens ? behind.high : face.high) : outer_high;
    CreaseEnds ends;
    float least = -half_chord;
    float most = half_chord;
    if (creased) {
        ends = crease_ends(crease);
        least = max(least, ends.low);
        most = min(most, ends.high);
    }
    float before = min(inner_low, most) - max(outer_low, least);
    float after = min(outer_high, most) - max(inner_high, least);
    bool first = !has_inner || (FACE_PIECES == 1u ? before > after : before > 0.0);
    float from = first ? outer_low : inner_high;
    float to = first ? inner_low : outer_high;
    FaceFootprint result;
    bool outer_behind = !opens && wall, from_behind = first ? outer_behind : opens;
    bool to_behind = first && has_inner ? opens : outer_behind;
    result.integral = face_piece(ray, cut, creased, crease, ends, from, to, from_behind, to_behind, half_chord, slice);
    if (FACE_PIECES == 2u) {
        float other = face_piece(ray, cut, creased, crease, ends, inner_high, outer_high, opens, outer_behind, half_chord, slice);
        result.integral += first && has_inner ? other : 0.0;
    }
    result.integral = has_outer && half_chord > 0.0 ? result.integral : 0.0;
    // If a ray only touches a face, its path splits into two pieces. The ray leaves by the last one, so that its colour
    // is continuous.
    bool last = FACE_PIECES == 2u && first && has_inner && after > 0.0;
    to = last ? outer_high : to;
    int from_plane = 0;
    int to_plane = 0;
    if (creased) {
        from_plane = ends.low > from ? ends.low_plane : 0;
        to_plane = ends.high < to ? ends.high_plane : 0;
        from = max(from, ends.low);
        to = max(min(to, ends.high), from);
    }
    result.entry = face_end(ray, cut, clamp(from, -half_chord, half_chord), from_plane);
    result.leave = face_end(ray, cut, clamp(to, -half_chord, half_chord), to_plane);
    return result;
}
#endif

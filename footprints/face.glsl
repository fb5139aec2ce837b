// Integrates kernels that a face cuts along a ray (docs/method/faces.md). Written in the subset of GLSL that is C++: shaders
// include it in float, footprints/face.cpp in double. The includer declares FACE_PIECES: the pieces of a ray that count, 2,
// or 1 if all matter is opaque, then the longer of two; FOOTPRINT_NODES, FOOTPRINT_RULE, FOOTPRINT_NODE and FOOTPRINT_WEIGHT:
// a rule for the interval from 0 to 1; and what face_cut.glsl needs.
#ifndef EDGESPLAT_FACE_GLSL
#define EDGESPLAT_FACE_GLSL
#include "footprints/face_types.glsl"
#include "footprints/face_cut.glsl"

Real quadratic_at(Quadratic q, Real z) { return q.c + z * (q.b + z * q.a); }

// Where phi = -level. No root loses digits to cancellation. If phi is almost linear, one root is out of every kernel's
// reach.
FaceRoots face_roots(Quadratic phi, Real level) {
    Real c = phi.c + level;
    Real a = abs(phi.a) < FACE_STRAIGHT ? (phi.a < 0.0 ? -FACE_STRAIGHT : FACE_STRAIGHT) : phi.a;
    Real disc = phi.b * phi.b - 4.0 * a * c;
    Real root = sqrt(max(disc, 0.0));
    Real q = -0.5 * (phi.b + (phi.b < 0.0 ? -root : root));
    Real far = q / a;
    Real near = q != 0.0 ? c / q : far;
    FaceRoots r;
    r.real = disc >= 0.0;
    r.low = min(near, far);
    r.high = max(near, far);
    return r;
}

// Of the face phi = -level. `side` -1: the matter lies where phi is larger.
FacePlane face_plane(FaceRay ray, Real depth, Real z, Real level, Real side) {
    Real inverse = side * inversesqrt(max(quadratic_at(ray.slope2, z), 1e-8));
    FacePlane plane;
    plane.p = (ray.across + z * ray.turn) * inverse;
    plane.u = (ray.phi.b + 2.0 * z * ray.phi.a) * inverse;
    plane.level = plane.p + z * plane.u - (quadratic_at(ray.phi, z) + level) * inverse - depth;
    return plane;
}

// True if no point of the ray between the two ends is moved, because both ends are deep.
bool is_deep(FacePlane plane, Real z, Real other) { return plane.p + max(z * plane.u, other * plane.u) <= plane.level; }

CreaseEnds plane_ends(Real p, Real u, Real distance, int plane) {
    Real way = abs(u) < FACE_STRAIGHT ? (u < 0.0 ? -FACE_STRAIGHT : FACE_STRAIGHT) : u;
    Real z = (distance - p) / way;
    CreaseEnds ends;
    ends.low = way < 0.0 ? z : -FACE_NOWHERE;
    ends.high = way < 0.0 ? FACE_NOWHERE : z;
    ends.low_plane = plane;
    ends.high_plane = plane;
    return ends;
}

CreaseEnds no_crease_ends() {
    CreaseEnds ends;
    ends.low = -FACE_NOWHERE;
    ends.high = FACE_NOWHERE;
    ends.low_plane = 0;
    ends.high_plane = 0;
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
FaceEnd face_end(FaceRay ray, FaceCut cut, Real z, int plane) {
    FaceEnd end;
    end.z = z;
    end.side = plane == 0 && quadratic_at(ray.phi, z) < -BESIDE_OTHER * cut.thickness ? -1.0 : 1.0;
    end.plane = plane;
    return end;
}

// The pieces of a ray. `creased` is a constant at every call, so that scenes without creases compile to no code for them.
FaceWay face_way(FaceRay ray, FaceCut cut, bool creased, CreaseEnds ends) {
    FaceWay way;
    way.half_chord = sqrt(max(cut.reach2 - ray.rho2, 0.0));
    bool wall = cut.thickness < FACE_NO_WALL;
    // Along the ray, phi has a minimum (opens) or a maximum between its zeros.
    bool opens = ray.phi.a >= 0.0;
    FaceRoots face = face_roots(ray.phi, 0.0);
    FaceRoots behind = face_roots(ray.phi, cut.thickness);
    behind.real = behind.real && wall;
    bool everywhere = !opens && !wall;
    bool has_outer = everywhere || (opens ? face.real : behind.real);
    Real outer_low = everywhere ? -FACE_NOWHERE : (opens ? face.low : behind.low);
    Real outer_high = everywhere ? FACE_NOWHERE : (opens ? face.high : behind.high);
    bool has_inner = opens ? behind.real : face.real;
    Real inner_low = has_inner ? (opens ? behind.low : face.low) : outer_high;
    Real inner_high = has_inner ? (opens ? behind.high : face.high) : outer_high;
    Real least = -way.half_chord;
    Real most = way.half_chord;
    if (creased) {
        least = max(least, ends.low);
        most = min(most, ends.high);
    }
    Real before = min(inner_low, most) - max(outer_low, least);
    Real after = min(outer_high, most) - max(inner_high, least);
    bool first = !has_inner || (FACE_PIECES == 1u ? before > after : before > 0.0);
    way.there = has_outer && way.half_chord > 0.0;
    way.both = FACE_PIECES == 2u && first && has_inner;
    way.goes_on = way.both && after > 0.0;
    bool outer_behind = !opens && wall;
    way.low = first ? outer_low : inner_high;
    way.high = first ? inner_low : outer_high;
    way.from_behind = first ? outer_behind : opens;
    way.to_behind = first && has_inner ? opens : outer_behind;
    way.second_low = inner_high;
    way.second_high = outer_high;
    way.second_from_behind = opens;
    way.second_to_behind = outer_behind;
    return way;
}

// The piece between two ends. Near each end, the tangent plane there moves the points. `from_behind`, `to_behind`: the ray
// enters or leaves through the wall's other face.
FacePiece face_piece(FaceRay ray, FaceCut cut, bool creased, FaceCrease crease, CreaseEnds ends, Real half_chord, Real from, Real to,
                     bool from_behind, bool to_behind) {
    // A ray that meets no face is nearest to it where phi has its extremum.
    bool meets = from > -FACE_NOWHERE || to < FACE_NOWHERE;
    Real turn = -0.5 * ray.phi.b / min(ray.phi.a, -FACE_STRAIGHT);
    FacePiece piece;
    piece.entry = face_plane(ray, cut.depth, clamp(meets ? from : turn, -half_chord, half_chord), from_behind ? cut.thickness : Real(0.0),
                             from_behind ? -1.0 : 1.0);
    piece.leave = face_plane(ray, cut.depth, clamp(meets ? to : turn, -half_chord, half_chord), to_behind ? cut.thickness : Real(0.0),
                             to_behind ? -1.0 : 1.0);
    piece.low = from;
    piece.high = to;
    piece.edge.p = 0.0;
    piece.edge.u = 0.0;
    piece.edge.level = FACE_NOWHERE;
    if (creased) {
        piece.edge.p = crease.p;
        piece.edge.u = crease.u;
        piece.edge.level = crease.distance - cut.depth;
        piece.low = max(from, ends.low);
        piece.high = max(min(to, ends.high), piece.low);
    }
    return piece;
}

// |x|^2 of the position at which the kernel is sampled for the point z of the ray, minus rho2. A point is moved by the plane
// of the nearer end of its piece.
Real sampled_beyond(FaceRay ray, FacePiece piece, bool creased, FaceCrease crease, Real z) {
    bool late = z > 0.5 * (piece.low + piece.high);
    FacePlane plane;
    plane.p = late ? piece.leave.p : piece.entry.p;
    plane.u = late ? piece.leave.u : piece.entry.u;
    plane.level = late ? piece.leave.level : piece.entry.level;
    Real t = plane.p + z * plane.u;
    Real held = min(t, plane.level);
    Real beyond = z * z - t * t + held * held;
    if (creased) {
        Real across = piece.edge.p + z * piece.edge.u + (held - t) * crease.facing;
        Real kept = min(across, piece.edge.level);
        beyond += kept * kept - across * across;
    }
    // A face is curved: a point moved along two normals may seem to be nearer than the voxel. Rounding may move it far.
    return max(beyond, -ray.rho2);
}

// The cut kernel at the point z of the ray, which lies in the piece.
Real kernel_in_piece(FaceRay ray, FacePiece piece, bool creased, FaceCrease crease, Real z) {
    return kernel_at(1.0 - (ray.rho2 + sampled_beyond(ray, piece, creased, crease, z)) * KERNEL_INVERSE_R2);
}

// Integral of the kernel over the part of a piece that lies in a slice.
Real integral_over(FaceRay ray, FaceCut cut, bool creased, FaceCrease crease, FacePiece piece, Real half_chord, Slice slice) {
    Real plain = sqrt(max(KERNEL_R2 - ray.rho2, 0.0));
    Real core = 1.0 - ray.rho2 * KERNEL_INVERSE_R2;
    // Deeper than all moved points, nothing lies beyond the plain kernel's reach. In a wall, this must be true up to
    // half_chord, because its other face may be tilted.
    Real far = cut.thickness < FACE_NO_WALL ? half_chord : plain;
    bool deep_before = is_deep(piece.entry, -plain, -far) && (!creased || is_deep(piece.edge, -plain, -far));
    bool deep_behind = is_deep(piece.leave, plain, far) && (!creased || is_deep(piece.edge, plain, far));
    Real begin = max(max(piece.low, deep_before ? -plain : -half_chord), slice.low);
    Real len = max(min(min(piece.high, deep_behind ? plain : half_chord), slice.high) - begin, 0.0);
    Real sum = 0.0;
    for (int k = 0; k < FOOTPRINT_NODES; ++k) {
        Real beyond = sampled_beyond(ray, piece, creased, crease, begin + len * FOOTPRINT_NODE[FOOTPRINT_RULE + k]);
        sum += FOOTPRINT_WEIGHT[FOOTPRINT_RULE + k] * kernel_at(core - beyond * KERNEL_INVERSE_R2);
    }
    return len * sum;
}

// The footprint of a cut kernel on a ray. No loop depends on the splat, because lavapipe would keep no variable in a
// register across such a loop.
FaceFootprint footprint_face(FaceRay ray, FaceCut cut, bool creased, FaceCrease crease, Slice slice) {
    CreaseEnds ends = no_crease_ends();
    if (creased) ends = crease_ends(crease);
    FaceWay way = face_way(ray, cut, creased, ends);
    FacePiece piece = face_piece(ray, cut, creased, crease, ends, way.half_chord, way.low, way.high, way.from_behind, way.to_behind);
    FaceFootprint result;
    result.integral = integral_over(ray, cut, creased, crease, piece, way.half_chord, slice);
    if (FACE_PIECES == 2u) {
        FacePiece other = face_piece(ray, cut, creased, crease, ends, way.half_chord, way.second_low, way.second_high, way.second_from_behind,
                                     way.second_to_behind);
        Real more = integral_over(ray, cut, creased, crease, other, way.half_chord, slice);
        result.integral += way.both ? more : Real(0.0);
    }
    result.integral = way.there ? result.integral : Real(0.0);
    // All slices of a kernel show what the whole kernel shows. If a ray only touches a face, its path splits into two
    // pieces. The ray leaves by the last one, so that its colour is continuous.
    Real from = way.low;
    Real to = way.goes_on ? way.second_high : way.high;
    int from_plane = 0;
    int to_plane = 0;
    if (creased) {
        from_plane = ends.low > from ? ends.low_plane : 0;
        to_plane = ends.high < to ? ends.high_plane : 0;
        from = max(from, ends.low);
        to = max(min(to, ends.high), from);
    }
    result.entry = face_end(ray, cut, clamp(from, -way.half_chord, way.half_chord), from_plane);
    result.leave = face_end(ray, cut, clamp(to, -way.half_chord, way.half_chord), to_plane);
    return result;
}
#endif

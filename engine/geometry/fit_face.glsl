// Fits a splat's face: the quadric with the least squared error to the surfels around. docs/method/faces.md. Written in the
// subset of GLSL that is C++. The includer declares `dims`, voxel(ivec3), material_at(ivec3), field_gradient(ivec3),
// trilinear(ivec3, vec3), lower_end(material) and upper_end(material): the ends of a material's interval, and the constant
// TWO_VALUES. Include after quadric.glsl and surfel.glsl.
#ifndef EDGESPLAT_FIT_FACE_GLSL
#define EDGESPLAT_FIT_FACE_GLSL

struct Face {
    Edge edge;
    Bending h;
    bool mixed;  // opposite surfels around are the other end of the material's interval
    bool creased;
    Plane crease;
    Real corner;  // distance of a third plane, negative if its normal is against the cross product of the other two; NO_PLANE: none
    bool traced;  // of a surface splat: the face is refused, and rays find the surface
    Real steep;   // weight of the field's direction at the voxel, 0 to 1
};

Face plain_face(Edge edge) {
    Face face = {edge, no_bending(), false, false, no_plane(), NO_PLANE, false, 0.0};
    return face;
}

// Weight of a surfel with the normal `other` at r from the middle, where the surface has the normal n. Opposite surfels
// may lie on the other side of the same wall, so they have a larger radius.
Real surfel_weight(vec3 r, vec3 n, vec3 other) {
    Real along = dot(r, n);
    Real opposed = clamp(-2.0 * dot(n, other), 0.0, 1.0);
    Real shorter = 1.0 - 0.5 * opposed;
    Real w = 1.0 - (dot(r, r) - along * along * (1.0 - shorter * shorter)) * (1.0 / (FIT_RADIUS * FIT_RADIUS));
    w = max(w, 0.0);
    return w * w;
}

// How far at least the surfel of a voxel at v from the middle lies from it, if it has a weight.
Real least_of_weight(vec3 v, vec3 n) {
    Real along = dot(v, n);
    return sqrt(max(dot(v, v) - 0.75 * along * along, 0.0)) - FIT_RADIUS - 1e-3;
}

// Distances of the surfels from the quadrics, as sums of w * distance^2; for the wall also sums of w and w * distance.
struct FitErrors {
    Real one;
    Real own;
    Real same;
    Real opposite;
    Real opposite_sum;
    Real opposite_sum2;
};

// A set of the 125 voxels around a voxel.
struct Around {
    uint bits[4];
};

Around none_around() {
    Around none;
    for (int k = 0; k < 4; ++k) none.bits[k] = 0u;
    return none;
}

// `used`: the voxels around `middle` whose surfels were fitted.
FitErrors fit_errors(ivec3 p, uint material, Around used, vec3 middle, vec3 n, Quadric one, Quadric wall, Quadric own) {
    FitErrors e = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    ivec3 around = voxel_near(p, middle);
    for (int k = 0; k < 4; ++k) {
        uint bits = used.bits[k];
        while (bits != 0u) {
            Surfel s = surfel_at(p, around + around_at(32 * k + findLSB(bits)), material, 0.0);
            bits &= bits - 1u;
            vec3 r = s.at - middle;
            Real w = surfel_weight(r, n, s.n);
            Real facing = dot(s.n, n);
            Real level = quadric_at(wall, r);
            Real off = quadric_off(one, r);
            e.one += w * off * off;
            Real own_off = quadric_off(own, r);
            e.own += w * own_off * own_off;
            e.same += facing > 0.0 ? w * level * level : 0.0;
            // Sideways surfels do not belong to a wall.
            bool opposed = facing < -0.5;
            e.same += facing <= 0.0 && !opposed ? w : 0.0;
            e.opposite += opposed ? w : 0.0;
            e.opposite_sum += opposed ? w * level : 0.0;
            e.opposite_sum2 += opposed ? w * level * level : 0.0;
        }
    }
    return e;
}

// Second-order expansion of the field around a voxel (docs/method/faces.md, 5), negative where the field is on the voxel's
// side of the iso-value. Scaled to a slope of about 1 at its zero.
struct Expansion {
    Quadric q;
    Real slope;  // the field's there
};

Expansion field_quadric(ivec3 p, Real iso, Real side) {
    ivec3 l = max(p - 1, ivec3(0));
    ivec3 h = min(p + 1, dims - 1);
    Real f = voxel(p);
    Real off = iso - f;
    vec3 low = vec3(voxel(ivec3(l.x, p.y, p.z)), voxel(ivec3(p.x, l.y, p.z)), voxel(ivec3(p.x, p.y, l.z)));
    vec3 high = vec3(voxel(ivec3(h.x, p.y, p.z)), voxel(ivec3(p.x, h.y, p.z)), voxel(ivec3(p.x, p.y, h.z)));
    vec3 g = 0.5 * (high - low);
    vec3 diagonal = high - 2.0 * f + low;
    Real yz = voxel(ivec3(p.x, h.y, h.z)) - voxel(ivec3(p.x, h.y, l.z)) - voxel(ivec3(p.x, l.y, h.z)) + voxel(ivec3(p.x, l.y, l.z));
    Real xz = voxel(ivec3(h.x, p.y, h.z)) - voxel(ivec3(h.x, p.y, l.z)) - voxel(ivec3(l.x, p.y, h.z)) + voxel(ivec3(l.x, p.y, l.z));
    Real xy = voxel(ivec3(h.x, h.y, p.z)) - voxel(ivec3(h.x, l.y, p.z)) - voxel(ivec3(l.x, h.y, p.z)) + voxel(ivec3(l.x, l.y, p.z));
    vec3 mixed = 0.25 * vec3(yz, xz, xy);
    Real norm = sqrt(dot(diagonal, diagonal) + 2.0 * dot(mixed, mixed));
    Real slope = sqrt(max(dot(g, g) + 2.0 * abs(off) * norm, 1e-12));
    Real scale = side / slope;
    Expansion result;
    result.q.c = scale * off;
    result.q.g = -scale * g;
    result.q.h.diagonal = -scale * diagonal;
    result.q.h.mixed = -scale * mixed;
    result.slope = slope;
    return result;
}

// The foot point of the voxel in the middle of its own expansion.
Foot own_foot_of(Quadric centred) {
    vec3 d = centred.h.diagonal;
    vec3 axis = d.x >= d.y && d.x >= d.z ? vec3(1.0, 0.0, 0.0) : (d.y >= d.z ? vec3(0.0, 1.0, 0.0) : vec3(0.0, 0.0, 1.0));
    return foot_of(centred, vec3(0.0), 0.1 * normalize(centred.g + 1e-3 * axis));
}

// The end of the matter along -n, from surfels that the fit does not use. Its normal must be parallel to the face's; if
// it is the same end of the interval, it may be tilted.
struct FaceBehind {
    Real away;  // 1e9: unknown
    vec3 n;
    uint state;
};

FaceBehind face_behind(ivec3 p, uint material, vec3 n, uint state) {
    FaceBehind behind = {1e9, -n, EDGE_NONE};
    for (int i = 1; i <= WALL_STEPS; ++i) {
        Surfel s = surfel_at(p, p + ivec3(roundEven(-Real(i) * n)), material, 0.0);
        Real facing = dot(s.n, n);
        Real away = dot(s.at, s.n) / -facing;
        bool faces = facing < (s.state == state ? -WALL_TILTED : -WALL_LEVEL);
        bool nearer = s.there && !s.border && faces && away > 0.0 && away < behind.away;
        behind.away = nearer ? away : behind.away;
        behind.n = nearer ? s.n : behind.n;
        behind.state = nearer ? s.state : behind.state;
    }
    return behind;
}

// Sums of squared distances of the samples around that lie on the wrong side of three quadrics about `middle`: `one`;
// the wall between `wall` and its level; the field's `own`.
vec3 wrong_sides(ivec3 p, uint material, vec3 middle, Quadric one, Quadric wall, Real level, Quadric own) {
    vec3 wrong = vec3(0.0);
    for (int i = 0; i < 27; ++i) {
        ivec3 q = p + sample_around(i);
        bool inside = is_matter_at(q, material);
        vec3 r = vec3(q - p) - middle;
        Real to_wall = quadric_at(wall, r);
        vec3 off = vec3(quadric_off(one, r), max(to_wall, level - to_wall), quadric_off(own, r));
        off = min(max(inside ? off : -off, 0.0), 1.0);
        wrong += off * off;
    }
    return wrong;
}

#include "engine/geometry/fit_crease.glsl"

// For matter beside a voxel, surfels beyond the outermost samples are ignored.
bool is_known(Surfel s, ivec3 p, bool beside) {
    vec3 at = vec3(p) + s.at;
    return !beside || (!s.border && all(greaterThanEqual(at, vec3(0.0))) && all(lessThanEqual(at, vec3(dims - 1))));
}

// The face of voxel p's kernel, for its own material or for a material beside it. No edge if no surface is in reach.
Face fit_face(ivec3 p, uint material) {
    Face face = plain_face(no_edge());
    uint own_material = material_at(p);
    bool beside = own_material != material;
    Surfel nearest = no_surfel();
    Real distance = 1e9;
    nearest.state = EDGE_LOWER;
    Surfel own_surfel = surfel_at(p, p, material, 0.0);
    Real bound = FACE_SEARCH;
    if (own_surfel.there && is_known(own_surfel, p, beside)) bound = length(own_surfel.at) + (own_surfel.border ? BORDER_BEHIND : 0.0) + 1e-3;
    for (int i = 0; i < 125; ++i) {
        ivec3 o = around_at(i);
        Surfel s = surfel_at(p, p + o, material, length(vec3(o)) - min(distance, bound));
        Real away = s.there ? length(s.at) : 1e9;
        // The volume's border ends the matter for every kernel, but only a face describes a surface beside it. So
        // surfaces rank first.
        Real rank = away + (s.border ? BORDER_BEHIND : 0.0);
        // The first of equally distant surfels is kept, independent of rounding.
        bool nearer = away < FACE_SEARCH && is_known(s, p, beside) && rank < distance - 1e-4;
        distance = nearer ? rank : distance;
        nearest.at = nearer ? s.at : nearest.at;
        nearest.n = nearer ? s.n : nearest.n;
        nearest.state = nearer ? s.state : nearest.state;
        nearest.border = nearer ? s.border : nearest.border;
    }
    vec3 middle = nearest.at;
    vec3 n = nearest.n;
    uint state = nearest.state;
    bool below = false;  // whether samples around are of materials below this one, or above it
    bool above = false;
    for (int i = 0; i < 27; ++i) {
        uint other = material_at(clamp(p + sample_around(i), ivec3(0), dims - 1));
        below = below || other < material;
        above = above || other > material;
    }
    bool found = distance < 1e9;
    if (nearest.border) {
        // A plane; the second face is the opposite border of the volume.
        Real d = dot(middle, n);
        face.edge.n = n;
        face.edge.d = d;
        face.edge.d2 = dot(abs(n), vec3(volume_dims())) - d;
        face.edge.state = EDGE_LOWER;
        return face;
    }
    if (!found) state = (beside ? own_material < material : below) ? EDGE_LOWER : EDGE_UPPER;
    IF_ANY(found || below || above) {
        Moments sums = no_moments();
        Moments same = no_moments();
        Real mixed = 0.0;
        Around used = none_around();
        Different different = none_different(CREASE_ROUNDED);
        ivec3 around = voxel_near(p, middle);
        for (int i = 0; i < 125; ++i) {
            ivec3 q = around + around_at(i);
            Surfel s = surfel_at(p, q, material, TWO_VALUES == 1u ? 0.0 : least_of_weight(vec3(q - p) - middle, n));
            vec3 r = s.at - middle;
            Real w = s.there && !s.border ? surfel_weight(r, n, s.n) : 0.0;
            IF_ANY(w > 0.0) {
                used.bits[i >> 5] |= w > 0.0 ? 1u << (i & 31) : 0u;
                add_surfel(sums, r, s.n, w);
                add_surfel(same, r, s.n, dot(s.n, n) > 0.0 ? w : 0.0);
                mixed += dot(s.n, n) < 0.0 ? (s.state != state ? w : -w) : 0.0;
            }
            if (TWO_VALUES == 1u) see_different(different, s, middle, state, dot(s.n, n));
        }
        // If no opposite surfel is in reach, a layer ends at its lower values.
        face.mixed = mixed > 0.0 || (mixed == 0.0 && state == EDGE_UPPER);
        Quadric one = quadric_of(sums);
        Quadric wall = quadric_of(same);
        bool upper = state == EDGE_UPPER;
        Real iso = upper ? upper_end(material) : lower_end(max(material, 1u));
        Expansion expansion = field_quadric(p, iso, upper ? -1.0 : 1.0);
        Quadric own = quadric_about(expansion.q, middle);
        FitErrors e = fit_errors(p, material, used, middle, n, one, wall, own);
        // The two faces of a wall are level sets of one quadric, fitted to the nearer face.
        Real level = e.opposite_sum / max(e.opposite, 1e-20);
        Real wall_error = e.same + max(e.opposite_sum2 - e.opposite_sum * level, 0.0);
        bool is_wall = e.opposite > 0.0 && level < -FIT_THINNEST && wall_error < FIT_WALL * e.one;
        vec3 wrong = wrong_sides(p, material, middle, one, wall, level, own);
        Real error = is_wall ? wall_error + wrong.y : e.one + wrong.x;
        Real own_error = e.own + wrong.z;
        Quadric q = one;
        if (is_wall) q = wall;
        Foot foot = foot_of(q, -middle, vec3(0.0));
        // If no single quadric fits the surfels around, the field's own may: at specks, corners, and structures thinner
        // than a voxel.
        bool is_own = !found || (error > FIT_WELL && own_error < (error > FIT_BADLY ? Real(1.0) : FIT_OWN) * error);
        IF_ANY(is_own || !foot.real) {
            Foot from_voxel = own_foot_of(expansion.q);
            is_own = is_own || (!foot.real && from_voxel.real);
            if (is_own) foot = from_voxel;
            if (is_own) q = expansion.q;
        }
        is_wall = is_wall && !is_own;
        if (TWO_VALUES == 1u) {
            IF_ANY(found) {
                CreaseSight sight = {p, material, middle, n, state};
                CreaseFit crease = fit_crease(sight, different.n);
                Real left = 1e9;
                IF_ANY(crease.found) left = crease_error(sight, crease);
                face.creased = explains_more(crease, left, is_own ? own_error : error);
                face.crease = crease.second;
                face.corner = corner_of(crease);
                face.edge.n = crease.first.n;
                face.edge.d = crease.first.away;
                face.edge.state = state;
            }
        }
        if (face.creased) return face;
        vec3 about = is_own ? vec3(0.0) : middle;
        Real scale = foot.real ? 1.0 / length(foot.slope) : 0.0;
        face.edge.n = foot.real ? scale * foot.slope : n;
        face.edge.d = dot(about + (foot.real ? foot.at : vec3(0.0)), face.edge.n);
        face.edge.state = is_own && !foot.real ? EDGE_NONE : state;
        // Beside matter, the expansion may have a surface where the field has none.
        IF_ANY(is_own && beside) {
            Real off = abs(trilinear(p, face.edge.d * face.edge.n) - iso);
            if (is_own && beside && !(off < MADE_UP * expansion.slope)) face.edge.state = EDGE_NONE;
        }
        face.h = scaled(q.h, scale);
        if (foot.real && is_wall) face.edge.d2 = max(-level * scale - face.edge.d, 0.0);
        // In a layer so thin that the samples around lie on both sides, and perhaps none inside, the fit may contain
        // only one face.
        bool layer = beside && below && above && !is_wall;
        if (layer) face.edge.d2 = (upper_end(material) - lower_end(material)) / expansion.slope - face.edge.d;
        // In a thicker wall the fit contains only one face. No wall if the face bends outwards strongly over the
        // thickness.
        vec3 out_of = face.edge.n;
        Real d = face.edge.d;
        FaceBehind behind = face_behind(p, material, out_of, state);
        bool one_sided = foot.real && !is_wall;
        bool thick = one_sided && behind.away < 1e9 && largest_bend(face.h) * (d + behind.away) < WALL_BENT;
        face.edge.d2 = thick ? behind.away : face.edge.d2;
        face.mixed = thick ? behind.state != state : layer || face.mixed;
        // In a wall, the slope turns from one face's normal to the other's. Elsewhere, if the fit saw no opposite side,
        // it turns to the field's slope at the voxel; a shallow slope changes direction quickly.
        bool alone = one_sided && !thick && !is_own && e.opposite == 0.0;
        vec3 turn = behind.n / (-dot(behind.n, out_of) * (d + behind.away));
        IF_ANY(one_sided && !is_own) {
            vec3 g = (upper ? 1.0 : -1.0) * field_gradient(p);
            Real slope = length(g);
            Real mean_slope = abs(voxel(p) - iso) / max(abs(d), 1e-6);
            Real depth = beside ? d : max(d, 0.0);
            if (alone) turn = -g / max(slope, 1e-30) * depth / (depth * depth + TURN_FROM);
            face.steep = one_sided && !is_own ? clamp((slope / max(mean_slope, 1e-6) - STEEP_FROM) / STEEP_OVER, 0.0, 1.0) : 0.0;
        }
        Real share = thick ? 1.0 : clamp(2.0 * length(expansion.q.g) - 1.0, 0.0, 1.0);
        if (thick || alone) face.h = turned_along(face.h, out_of, turn, share);
        // The face on the voxel's side of the layer comes first.
        bool far = layer && face.edge.state != EDGE_NONE && face.edge.d2 < 0.0;
        if (far) {
            face.edge.n = -out_of;
            face.edge.d = face.edge.d2;
            face.edge.d2 = d;
            face.edge.state = upper ? EDGE_LOWER : EDGE_UPPER;
            face.h = scaled(face.h, -1.0);
        }
    }
    return face;
}

// The face that cuts voxel p's kernel of a material, or an edge that only lights it. Beside matter that reaches no such face
// D is CARRIES_NOTHING. `through`: the matter is translucent; `band`: edges further away are none.
Face finished_face(ivec3 p, uint material, bool through, Real band) {
    // The voxel's own surfel is one point of the surface; the fitted face uses all surfels around.
    Face face = fit_face(p, material);
    bool near = face.edge.state >= EDGE_LOWER && abs(face.edge.d) <= band;
    bool cut = near && (!through || abs(face.edge.d) < KERNEL_RADIUS);
    vec3 g = cut ? vec3(0.0) : field_gradient(p);
    Edge plain = normal_only(g);
    // If the face is too far away to cut the kernel, the splat is lit with the face's normal at the voxel.
    vec3 under = (face.edge.state == EDGE_UPPER ? -1.0 : 1.0) * (face.edge.n - face.edge.d * bent(face.h, face.edge.n));
    vec3 lit = mix(under / max(length(under), 1e-6), plain.n, plain.state == EDGE_NORMAL ? face.steep : 0.0);
    bool is_lit = near && dot(lit, lit) > 1e-6;
    if (is_lit) plain.n = normalize(lit);
    if (is_lit) plain.state = EDGE_NORMAL;
    if (material_at(p) != material) {
        plain = no_edge();
        plain.d = CARRIES_NOTHING;
        plain.state = EDGE_LOWER;
    }
    if (!cut) face = plain_face(plain);
    return face;
}
#endif

// Fits a splat's face: the quadric with the least squared error to the surfels around. docs/method.md, pass 2, faces;
// mirrored by engine/reference/faces.h. The including shader declares `edges` (rg32ui uimage3D), `dims`,
// `material_at(ivec3)`, `field_gradient(ivec3)` and `trilinear(ivec3, vec3)`.
#include "shaders/drivers/if_any.glsl"
#include "shaders/edges/edge_record.glsl"
#include "shaders/splats/crease_record.glsl"
#include "shaders/footprints/face_record.glsl"
#include "shaders/splats/quadric.glsl"

// Only between samples of two values is the shape of the field unknown: there creases are looked for, which the spline rounds.
layout(constant_id = SPEC_TWO_VALUES) const uint TWO_VALUES = 0u;

struct Surfel {
    bool there;
    vec3 at;  // relative to the voxel
    vec3 n;   // out of the voxel's material
    uint state;  // the end of the material's interval that it lies on
    bool border; // it lies on the volume's border
};

float distance_in(uint code) { return abs(float(int(code << 16) >> 16)) * (EDGE_DISTANCE_UNIT / 32767.0); }

// The surfel of voxel q, relative to voxel p. `material`: the material that it must bound, from either side. `lost`: how
// far it must lie from its voxel, or it is of no use and may be left out.
Surfel surfel_at(ivec3 p, ivec3 q, uint material, float lost) {
    Surfel s = Surfel(false, vec3(0.0), vec3(0.0), EDGE_NONE, false);
    bool inside = all(greaterThanEqual(q, ivec3(0))) && all(lessThan(q, dims));
    ivec3 held = clamp(q, ivec3(0), dims - 1);
    uvec2 code = imageLoad(edges, held).xy;
    uint state = code.y >> 26 & 3u;
    // The volume's border only bounds the material inside it.
    bool at_border = (code.y & EDGE_BORDER) != 0u;
    IF_ANY(inside && state >= EDGE_LOWER && distance_in(code.y) >= lost) {
        Edge e = unpack_edge(code.x, code.y);
        uint own = material_at(held);
        // An upper end is the lower end of the material above.
        bool ours = own == material, below = own + 1u == material && state == EDGE_UPPER && !at_border;
        bool above = own == material + 1u && state == EDGE_LOWER && !at_border;
        s.there = ours || below || above;
        s.at = vec3(q - p) + e.d * e.n;
        s.n = ours ? e.n : -e.n;
        s.border = at_border;
        s.state = ours ? state : (below ? EDGE_LOWER : EDGE_UPPER);
    }
    return s;
}

// Weight of a surfel with the normal `other` at r from the middle, where the surface has the normal n. Opposite surfels
// may lie on the other side of the same wall, so they have a larger radius.
float surfel_weight(vec3 r, vec3 n, vec3 other) {
    float along = dot(r, n);
    float turned = clamp(-2.0 * dot(n, other), 0.0, 1.0);
    float shorter = 1.0 - 0.5 * turned;
    float w = 1.0 - (dot(r, r) - along * along * (1.0 - shorter * shorter)) * (1.0 / (FIT_RADIUS * FIT_RADIUS));
    w = max(w, 0.0);
    return w * w;
}

// How far at least the surfel of a voxel at v from the middle lies from it, if it has a weight.
float least_of_weight(vec3 v, vec3 n) {
    float along = dot(v, n);
    return sqrt(max(dot(v, v) - 0.75 * along * along, 0.0)) - FIT_RADIUS - 1e-3;
}

struct Face {
    Edge edge;
    Bending h;
    bool mixed;  // opposite surfels around are the other end of the material's interval
    bool creased;
    vec4 crease;
    float corner;  // in the format of pack_crease()
    bool traced;  // of a surface splat: the face is refused, and rays find the surface
    float steep;  // weight of the field's direction at the voxel, 0 to 1
};

// Distances of the surfels from the quadrics, as sums of w * distance^2; for the wall also sums of w and w * distance.
struct FitErrors {
    float weight;
    float one;
    float own;
    float same;
    float opposite;
    float opposite_sum;
    float opposite_sum2;
};

// A set of the 125 voxels around a voxel.
struct Around {
    uint bits[4];
};

Around none_around() { return Around(uint[4](0u, 0u, 0u, 0u)); }

// The offset of the i-th of them.
ivec3 around_at(int i) { return ivec3(i % 5, i / 5 % 5, i / 25) - 2; }

// `used`: the voxels around `middle` whose surfels were fitted.
FitErrors fit_errors(ivec3 p, uint material, Around used, vec3 middle, vec3 n, Quadric one, Quadric wall, Quadric own) {
    FitErrors e = FitErrors(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    ivec3 around = p + ivec3(round(middle));
    for (int k = 0; k < 4; ++k) {
        uint bits = used.bits[k];
        while (bits != 0u) {
            Surfel s = surfel_at(p, around + around_at(32 * k + findLSB(bits)), material, 0.0);
            bits &= bits - 1u;
            vec3 r = s.at - middle;
            float w = surfel_weight(r, n, s.n), facing = dot(s.n, n), level = quadric_at(wall, r);
            float off = quadric_at(one, r) / max(length(quadric_slope(one, r)), 0.2);
            e.weight += w;
            e.one += w * off * off;
            float own_off = quadric_at(own, r) / max(length(quadric_slope(own, r)), 0.2);
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

// Second-order expansion of the field around voxel p, negative where the field is on the voxel's side of `iso`; design
// (13). Scaled to a slope of about 1 at its zero; `slope` is the field's slope there.
Quadric field_quadric(ivec3 p, float iso, float side, out float slope) {
    ivec3 l = max(p - 1, ivec3(0)), h = min(p + 1, dims - 1);
    float f = voxel(p), off = iso - f;
    vec3 low = vec3(voxel(ivec3(l.x, p.yz)), voxel(ivec3(p.x, l.y, p.z)), voxel(ivec3(p.xy, l.z)));
    vec3 high = vec3(voxel(ivec3(h.x, p.yz)), voxel(ivec3(p.x, h.y, p.z)), voxel(ivec3(p.xy, h.z)));
    vec3 g = 0.5 * (high - low), diagonal = high - 2.0 * f + low;
    vec3 mixed = 0.25 * vec3(voxel(ivec3(p.x, h.yz)) - voxel(ivec3(p.x, h.y, l.z)) - voxel(ivec3(p.x, l.y, h.z)) + voxel(ivec3(p.x, l.yz)),
                             voxel(ivec3(h.x, p.y, h.z)) - voxel(ivec3(h.x, p.y, l.z)) - voxel(ivec3(l.x, p.y, h.z)) + voxel(ivec3(l.x, p.y, l.z)),
                             voxel(ivec3(h.xy, p.z)) - voxel(ivec3(h.x, l.y, p.z)) - voxel(ivec3(l.x, h.y, p.z)) + voxel(ivec3(l.xy, p.z)));
    float norm = sqrt(dot(diagonal, diagonal) + 2.0 * dot(mixed, mixed));
    slope = sqrt(max(dot(g, g) + 2.0 * abs(off) * norm, 1e-12));
    float scale = side / slope;
    return Quadric(scale * off, -scale * g, Bending(-scale * diagonal, -scale * mixed));
}

// The same quadric around another point.
Quadric quadric_about(Quadric q, vec3 m) { return Quadric(quadric_at(q, m), quadric_slope(q, m), q.h); }

struct Foot {
    vec3 at, slope;
    bool real;  // false: the quadric has no surface in reach
};

// The foot point: the surface point whose normal passes through the voxel. Starts at `at`; all positions are relative
// to the quadric's origin.
Foot foot_of(Quadric q, vec3 voxel_at, vec3 at) {
    for (int i = 0; i < FOOT_STEPS; ++i) {
        vec3 slope = quadric_slope(q, at);
        float steep = length(slope);
        vec3 up = slope / max(steep, 1e-6);
        float bend = dot(up, bent(q.h, up)), value = quadric_at(q, at);
        float moved = -2.0 * value / (steep + sqrt(max(steep * steep - 2.0 * value * bend, 0.0)) + 1e-6);
        at += clamp(moved, -1.0, 1.0) * up;
        vec3 from = at - voxel_at;
        at -= i + 2 < FOOT_STEPS ? 0.7 * (from - dot(from, up) * up) : vec3(0.0);
    }
    vec3 slope = quadric_slope(q, at);
    return Foot(at, slope, length(slope) >= 0.3 && abs(quadric_at(q, at)) < 0.05 && length(at) < FIT_RADIUS);
}

// The end of the matter along -n, from surfels that the fit does not use. Its normal must be parallel to the face's; if
// it is the same end of the interval, it may be tilted.
struct FaceBehind {
    float away;  // 1e9: unknown
    vec3 n;
    uint state;
};

FaceBehind face_behind(ivec3 p, uint material, vec3 n, uint state) {
    FaceBehind behind = FaceBehind(1e9, -n, EDGE_NONE);
    for (int i = 1; i <= WALL_STEPS; ++i) {
        Surfel s = surfel_at(p, p + ivec3(roundEven(-float(i) * n)), material, 0.0);
        float facing = dot(s.n, n), away = dot(s.at, s.n) / -facing;
        bool faces = facing < (s.state == state ? -WALL_TILTED : -WALL_LEVEL);
        bool nearer = s.there && !s.border && faces && away > 0.0 && away < behind.away;
        behind.away = nearer ? away : behind.away;
        behind.n = nearer ? s.n : behind.n;
        behind.state = nearer ? s.state : behind.state;
    }
    return behind;
}

// Moves the component of H n perpendicular to n towards `turn`, by a share. This is how far the slope turns over a
// voxel along n. On the face itself the change is of third order.
Bending turned(Bending h, vec3 n, vec3 turn, float share) {
    vec3 hn = bent(h, n), change = share * (turn - hn);
    change -= dot(change, n) * n;
    return Bending(h.diagonal + 2.0 * n * change, h.mixed + n.yxx * change.zzy + change.yxx * n.zzy);
}

// Sums of squared distances of the samples around that lie on the wrong side of three quadrics about `middle`: `one`;
// the wall between `wall` and its level; the field's `own`.
vec3 wrong_sides(ivec3 p, uint material, vec3 middle, Quadric one, Quadric wall, float level, Quadric own) {
    vec3 wrong = vec3(0.0);
    for (int i = 0; i < 27; ++i) {
        ivec3 q = p + ivec3(i % 3, i / 3 % 3, i / 9) - 1;
        bool there = all(greaterThanEqual(q, ivec3(0))) && all(lessThan(q, dims));
        bool inside = there && material_at(clamp(q, ivec3(0), dims - 1)) == material;
        vec3 r = vec3(q - p) - middle;
        float to_wall = quadric_at(wall, r);
        vec3 off = vec3(quadric_at(one, r) / max(length(quadric_slope(one, r)), 0.2), max(to_wall, level - to_wall),
                        quadric_at(own, r) / max(length(quadric_slope(own, r)), 0.2));
        off = min(max(inside ? off : -off, 0.0), 1.0);
        wrong += off * off;
    }
    return wrong;
}

#include "shaders/splats/fit_crease.glsl"

// For matter beside a voxel, surfels beyond the outermost samples are ignored.
bool is_known(Surfel s, ivec3 p, bool beside) {
    vec3 at = vec3(p) + s.at;
    return !beside || (!s.border && all(greaterThanEqual(at, vec3(0.0))) && all(lessThanEqual(at, vec3(dims - 1))));
}

// The face of voxel p's kernel, for its own material or for a material beside it. No edge if no surface is in reach.
Face fit_face(ivec3 p, uint material) {
    Face face = Face(no_edge(), Bending(vec3(0.0), vec3(0.0)), false, false, CREASE_NONE, CORNER_NONE, false, 0.0);
    vec3 middle = vec3(0.0), n = vec3(0.0);
    float nearest = 1e9;
    uint state = EDGE_LOWER;
    bvec2 crossed = bvec2(false);
    uint own_material = material_at(p);
    bool border = false, beside = own_material != material;
    Surfel own_surfel = surfel_at(p, p, material, 0.0);
    float bound = own_surfel.there && is_known(own_surfel, p, beside) ? length(own_surfel.at) + (own_surfel.border ? BORDER_BEHIND : 0.0) + 1e-3 : FACE_SEARCH;
    for (int i = 0; i < 125; ++i) {
        ivec3 o = around_at(i);
        Surfel s = surfel_at(p, p + o, material, length(vec3(o)) - min(nearest, bound));
        float away = s.there ? length(s.at) : 1e9;
        // The volume's border ends the matter for every kernel, but only a face describes a surface beside it. So
        // surfaces rank first.
        float rank = away + (s.border ? BORDER_BEHIND : 0.0);
        // The first of equally distant surfels is kept, independent of rounding.
        bool nearer = away < FACE_SEARCH && is_known(s, p, beside) && rank < nearest - 1e-4;
        nearest = nearer ? rank : nearest;
        middle = nearer ? s.at : middle;
        n = nearer ? s.n : n;
        state = nearer ? s.state : state;
        border = nearer ? s.border : border;
    }
    for (int i = 0; i < 27; ++i) {
        uint other = material_at(clamp(p + ivec3(i % 3, i / 3 % 3, i / 9) - 1, ivec3(0), dims - 1));
        crossed.x = crossed.x || other < material;
        crossed.y = crossed.y || other > material;
    }
    bool found = nearest < 1e9;
    if (border) {
        // A plane; the second face is the opposite border of the volume.
        float d = dot(middle, n);
        face.edge = Edge(n, d, dot(abs(n), vec3(params.scene.volume_dims)) - d, EDGE_LOWER);
        return face;
    }
    if (!found) state = (beside ? own_material < material : crossed.x) ? EDGE_LOWER : EDGE_UPPER;
    IF_ANY(found || crossed.x || crossed.y) {
        Moments all = no_moments(), same = no_moments();
        float mixed = 0.0;
        Around used = none_around();
        Different different = none_different(CREASE_ROUNDED);
        ivec3 around = p + ivec3(round(middle));
        for (int i = 0; i < 125; ++i) {
            ivec3 q = around + around_at(i);
            Surfel s = surfel_at(p, q, material, TWO_VALUES == 1u ? 0.0 : least_of_weight(vec3(q - p) - middle, n));
            vec3 r = s.at - middle;
            float w = s.there && !s.border ? surfel_weight(r, n, s.n) : 0.0;
            IF_ANY(w > 0.0) {
                used.bits[i >> 5] |= w > 0.0 ? 1u << (i & 31) : 0u;
                add_surfel(all, r, s.n, w);
                add_surfel(same, r, s.n, dot(s.n, n) > 0.0 ? w : 0.0);
                mixed += dot(s.n, n) < 0.0 ? (s.state != state ? w : -w) : 0.0;
            }
            if (TWO_VALUES == 1u) see_different(different, s, middle, state, dot(s.n, n));
        }
        // If no opposite surfel is in reach, a layer ends at its lower values.
        face.mixed = mixed > 0.0 || (mixed == 0.0 && state == EDGE_UPPER);
        Quadric one = quadric_of(all), wall = quadric_of(same);
        bool upper = state == EDGE_UPPER;
        float iso = params.scene.iso[upper ? material : max(material, 1u) - 1u];
        float slope_there;
        Quadric centred = field_quadric(p, iso, upper ? -1.0 : 1.0, slope_there);
        Quadric own = quadric_about(centred, middle);
        FitErrors e = fit_errors(p, material, used, middle, n, one, wall, own);
        // The two faces of a wall are level sets of one quadric, fitted to the nearer face.
        float level = e.opposite_sum / max(e.opposite, 1e-20);
        float wall_error = e.same + max(e.opposite_sum2 - e.opposite_sum * level, 0.0);
        bool is_wall = e.opposite > 0.0 && level < -FIT_THINNEST && wall_error < FIT_WALL * e.one;
        vec3 wrong = wrong_sides(p, material, middle, one, wall, level, own);
        float error = is_wall ? wall_error + wrong.y : e.one + wrong.x;
        Quadric q = one;
        if (is_wall) q = wall;
        Foot foot = foot_of(q, -middle, vec3(0.0));
        // If no single quadric fits the surfels around, the field's own may: at specks, corners, and structures thinner
        // than a voxel.
        bool is_own = !found || (error > FIT_WELL && e.own + wrong.z < (error > FIT_BADLY ? 1.0 : FIT_OWN) * error);
        IF_ANY(is_own || !foot.real) {
            vec3 d = centred.h.diagonal;
            vec3 axis = d.x >= d.y && d.x >= d.z ? vec3(1.0, 0.0, 0.0) : d.y >= d.z ? vec3(0.0, 1.0, 0.0) : vec3(0.0, 0.0, 1.0);
            Foot from_voxel = foot_of(centred, vec3(0.0), 0.1 * normalize(centred.g + 1e-3 * axis));
            is_own = is_own || (!foot.real && from_voxel.real);
            if (is_own) {
                foot = from_voxel;
                q = centred;
            }
        }
        is_wall = is_wall && !is_own;
        if (TWO_VALUES == 1u) {
            IF_ANY(found) {
                CreaseSight sight = CreaseSight(p, material, middle, n, state);
                CreaseFit crease = fit_crease(sight, different.n);
                float left = 1e9, best = is_own ? e.own + wrong.z : error;
                IF_ANY(crease.found) left = crease_error(sight, crease);
                // At a blunt angle, a narrow ridge looks like two planes.
                bool blunt = dot(crease.first.xyz, crease.second.xyz) > CREASE_BLUNT;
                face.creased = left < (blunt ? CREASE_BLUNT_LEFT : FIT_OWN) * best || (!blunt && left < CREASE_ROUNDED_LEFT);
                face.crease = crease.second;
                face.corner = corner_of(crease);
                face.edge = Edge(crease.first.xyz, crease.first.w, 1e9, state);
            }
        }
        if (face.creased) return face;
        vec3 about = is_own ? vec3(0.0) : middle;
        float scale = foot.real ? 1.0 / length(foot.slope) : 0.0;
        face.edge.n = foot.real ? scale * foot.slope : n;
        face.edge.d = dot(about + (foot.real ? foot.at : vec3(0.0)), face.edge.n);
        face.edge.state = is_own && !foot.real ? EDGE_NONE : state;
        // Beside matter, the expansion may have a surface where the field has none.
        IF_ANY(is_own && beside) {
            float off = abs(trilinear(p, face.edge.d * face.edge.n) - iso);
            if (is_own && beside && !(off < MADE_UP * slope_there)) face.edge.state = EDGE_NONE;
        }
        face.h = Bending(scale * q.h.diagonal, scale * q.h.mixed);
        if (foot.real && is_wall) face.edge.d2 = max(-level * scale - face.edge.d, 0.0);
        // In a layer so thin that the samples around lie on both sides, and perhaps none inside, the fit may contain
        // only one face.
        bool layer = beside && crossed.x && crossed.y && !is_wall;
        if (layer) face.edge.d2 = (params.scene.iso[material] - params.scene.iso[material - 1u]) / slope_there - face.edge.d;
        // In a thicker wall the fit contains only one face. No wall if the face bends outwards strongly over the
        // thickness.
        vec3 out_of = face.edge.n;
        float d = face.edge.d;
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
            float slope = length(g), mean_slope = abs(voxel(p) - iso) / max(abs(d), 1e-6);
            float depth = beside ? d : max(d, 0.0);
            if (alone) turn = -g / max(slope, 1e-30) * depth / (depth * depth + TURN_FROM);
            face.steep = one_sided && !is_own ? clamp((slope / max(mean_slope, 1e-6) - STEEP_FROM) / STEEP_OVER, 0.0, 1.0) : 0.0;
        }
        float share = thick ? 1.0 : clamp(2.0 * length(centred.g) - 1.0, 0.0, 1.0);
        if (thick || alone) face.h = turned(face.h, out_of, turn, share);
        // The face on the voxel's side of the layer comes first.
        bool far = layer && face.edge.state != EDGE_NONE && face.edge.d2 < 0.0;
        if (far) {
            face.edge = Edge(-out_of, face.edge.d2, d, upper ? EDGE_LOWER : EDGE_UPPER);
            face.h = Bending(-face.h.diagonal, -face.h.mixed);
        }
    }
    return face;
}

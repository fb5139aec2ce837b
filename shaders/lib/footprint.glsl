// Footprints of plain and warped kernels: the float32 mirror of footprints/ (same names, same equations).
//
// Declares no bindings: the table comes in as a sampler, the rest as FootprintParams. A ray is (rho2, pn, un): p its point
// nearest to the voxel centre, relative to it, u its unit direction, n the unit edge normal, all in index space; rho2 = dot(p, p),
// pn = dot(p, n), un = dot(u, n). D, D2: distances to the edge along n and to a wall's second face along -n, voxels. Results are
// integrals of K per voxel length of the ray. Every input is safe: no NaN for un = 0 or 1, rho2 = 0, pn beyond rho.
//
//   footprint_isotropic(rho2, slice)                        a splat without an edge
//   footprint_warp2d(rho2, pn, un, D, slice, params)        --footprints warp2d
//   footprint_table_nearest(table, rho2, pn, un, D, params) --footprints table
//   footprint_table_lerp(table, rho2, pn, un, D, params)    --footprints table-lerp
//   footprint_procedural(rho2, pn, un, D, D2, faces, slice, params)  --footprints procedural; in the table modes walls
//                                                           and whatever is sliced
//   footprint_curved(rho2, pn, un, D, curvature, slice, params)  --edge-shape curved, but for walls
//   footprint_paper_warp2d(rho2, pn, un, D, slice, params)  --warp paper with warp2d
//   footprint_paper_procedural(rho2, pn, un, D, slice, params)  --warp paper with any other mode
//
// `faces` comes from footprint_faces(): with 0 the quadrature's loop does not run and the plain footprint is what is left. On
// lavapipe a loop that does not run is the only way not to pay: both sides of an `if` are executed.
//
// Written in the subset of GLSL that is C++ too (tests/unit/footprints_shader_test.cpp runs it): scalars, no swizzles.
#ifndef EDGESPLAT_FOOTPRINT_GLSL
#define EDGESPLAT_FOOTPRINT_GLSL
#include "shaders/lib/kernel.glsl"
#include "shaders/shared/footprint_params.h"

// Rules on [0, 1] with 4, 8, 10, 16 and 6 nodes, one after the other; the including shader declares NODES, one of them. Gauss-Legendre,
// but that the 8 crowd towards 0 (crowded() in footprints/gauss_legendre.h), where edge_piece has the face.
const float FOOTPRINT_NODE[44] = {
    0.0694318442, 0.3300094782, 0.6699905218, 0.9305681558, 0.0100270801, 0.0535558032, 0.1345804080, 0.2565045145,
    0.4201694235, 0.6165093518, 0.8154310090, 0.9610629543, 0.0130467357, 0.0674683167, 0.1602952159, 0.2833023029,
    0.4255628305, 0.5744371695, 0.7166976971, 0.8397047841, 0.9325316833, 0.9869532643, 0.0052995325, 0.0277124885,
    0.0671843988, 0.1222977958, 0.1910618778, 0.2709916112, 0.3591982246, 0.4524937451, 0.5475062549, 0.6408017754,
    0.7290083888, 0.8089381222, 0.8777022042, 0.9328156012, 0.9722875115, 0.9947004675,
    0.0337652429, 0.1693953068, 0.3806904070, 0.6193095930, 0.8306046932, 0.9662347571};
const float FOOTPRINT_WEIGHT[44] = {
    0.1739274226, 0.3260725774, 0.3260725774, 0.1739274226, 0.0258171918, 0.0617096157, 0.1009565004, 0.1431516153,
    0.1828725253, 0.2049369039, 0.1832302834, 0.0973253641, 0.0333356722, 0.0747256746, 0.1095431813, 0.1346333597,
    0.1477621124, 0.1477621124, 0.1346333597, 0.1095431813, 0.0747256746, 0.0333356722, 0.0135762297, 0.0311267620,
    0.0475792558, 0.0623144856, 0.0747979944, 0.0845782597, 0.0913017075, 0.0947253052, 0.0947253052, 0.0913017075,
    0.0845782597, 0.0747979944, 0.0623144856, 0.0475792558, 0.0311267620, 0.0135762297,
    0.0856622462, 0.1803807865, 0.2339569673, 0.2339569673, 0.1803807865, 0.0856622462};
const int FOOTPRINT_NODES = int(NODES);
const int FOOTPRINT_RULE = FOOTPRINT_NODES == 4 ? 0 : (FOOTPRINT_NODES == 8 ? 4 : (FOOTPRINT_NODES == 10 ? 12 : (FOOTPRINT_NODES == 6 ? 38 : 22)));

// A piece of the ray, z along u from p: a sheet's share of a footprint. All of it where footprints are not sliced.
struct Slice {
    float low;
    float high;
};

// ---- plain footprints (footprints/kernel.h)

// Integral of K along the line from its nearest point to z; kernel_chord in kernel.cpp has the recurrence.
float kernel_chord(float rho2, float z) {
    float w = max(0.0, 1.0 - rho2 * KERNEL_INVERSE_R2);
    float half_chord = KERNEL_R * sqrt(w);
    float s = clamp(z / max(half_chord, 1e-6), -1.0, 1.0);
    float c = 1.0 - s * s;
    float i1 = s - s * s * s * (1.0 / 3.0);
    float c2 = s * c * c;
    float c3 = c2 * c;
    float c4 = c3 * c;
    float c5 = c4 * c;
    float c6 = c5 * c;
    float c7 = c6 * c;
    float i2 = c2 * (1.0 / 5.0) + i1 * (4.0 / 5.0);
    float i3 = c3 * (1.0 / 7.0) + i2 * (6.0 / 7.0);
    float i4 = c4 * (1.0 / 9.0) + i3 * (8.0 / 9.0);
    float i5 = c5 * (1.0 / 11.0) + i4 * (10.0 / 11.0);
    float i6 = c6 * (1.0 / 13.0) + i5 * (12.0 / 13.0);
    float i7 = c7 * (1.0 / 15.0) + i6 * (14.0 / 15.0);
    return half_chord * w * w * (0.0173624837 * i2 + w * (-0.0404017909 * i3 + w * (0.531403221 * i4 +
           w * (-0.680940898 * i5 + w * (1.37803587 * i6 + w * -0.611612954 * i7)))));
}

float kernel_between(float rho2, float low, float high) { return kernel_chord(rho2, high) - kernel_chord(rho2, low); }

// The whole footprint has a closed form of its own, which costs less than two chords.
bool is_whole(Slice slice) { return slice.low <= -1e8 && slice.high >= 1e8; }

float footprint_isotropic(float rho2, Slice slice) {
    if (is_whole(slice)) return kernel_footprint(rho2);
    return max(0.0, kernel_between(rho2, slice.low, slice.high));
}

// Footprint of the point nearest to the voxel, moved by delta along n as far as the ray sees it.
float displaced_footprint(float rho2, float pn, float un, float delta, Slice slice) {
    return footprint_isotropic(max(0.0, rho2 + delta * (2.0 * pn + (1.0 - un * un) * delta)), slice);
}

// Faces to integrate: 2 for a wall, 1 for a single edge, 0 where the kernel stays plain (out of reach, or a wall under a voxel).
int footprint_faces(float D, float D2, FootprintParams params) {
    float reach = KERNEL_R + params.half_width;
    int faces = D2 < reach ? (D + D2 > 1.0 ? 2 : 0) : 1;
    return abs(D) < reach ? faces : 0;
}

// ---- quadrature along the ray (footprints/procedural_footprint.cpp)

// What the ray does near the voxel: z = along the ray from p, t = normal coordinate, turned so that t grows with z.
struct Chord {
    float rho2;
    float pn;
    float un;
    float low;   // z within R of the axis through the voxel along n; W never leaves that cylinder
    float high;
};

Chord chord_of(float rho2, float pn, float un, Slice slice) {
    Chord c;
    c.rho2 = rho2;
    c.pn = pn;
    c.un = clamp(abs(un), 1e-4, 1.0);
    float s2 = max(1.0 - c.un * c.un, 1e-5);
    float y2 = max(0.0, rho2 - pn * pn / s2);
    float half_length = sqrt(max(0.0, KERNEL_R2 - y2) / s2);
    c.low = max(pn * c.un / s2 - half_length, un < 0.0 ? -slice.high : slice.low);
    c.high = max(min(pn * c.un / s2 + half_length, un < 0.0 ? -slice.low : slice.high), c.low);
    return c;
}

float chord_plain(Chord c, float first, float last) {
    return kernel_between(c.rho2, clamp((first - c.pn) / c.un, c.low, c.high), clamp((last - c.pn) / c.un, c.low, c.high));
}

// What of a warped kernel is the same for all rays: the band of its faces and, of the first, between which t it is integrated.
struct FaceBand {
    float a;
    float k;
    float inverse_a;
    float first;
    float last;
};

// w in [-R, R] is all the kernel there is.
float face_first(float face, float a, float k) { return max(face - a, face + edge_warp_inverse(-KERNEL_R - face, a, k)); }
float face_last(float face, float a, float k) { return min(face + a, face + edge_warp_inverse(KERNEL_R - face, a, k)); }

// All but where it is integrated.
FaceBand face_widths(float D, float D2, int faces, FootprintParams params) {
    float thickness = D + D2;
    FaceBand band;
    band.a = faces == 2 ? wall_half_width(thickness, params.half_width) : params.half_width;
    band.k = faces == 2 ? wall_strength(thickness, params.strength) : params.strength;
    band.inverse_a = 1.0 / band.a;
    band.first = 0.0;
    band.last = 0.0;
    return band;
}

FaceBand face_band(float D, float D2, int faces, FootprintParams params) {
    FaceBand band = face_widths(D, D2, faces, params);
    band.first = face_first(D, band.a, band.k);
    band.last = face_last(D, band.a, band.k);
    return band;
}

// The warped kernel over the ray's part between z = near and near + side len, on one side of the face at `face`: side = 1 where
// t is larger there, else -1; `near` is the end nearer to the face. With x = |z - near| / len the squared distance from the axis
// along n, z^2 + rho^2 - t^2, is a quadratic in x, and with v = |t - face| / a the warped coordinate is w = face + side a g(v), g
// the rational quadratic of edge_warp: no division but that of g. All in radii of the kernel.
float edge_piece(Chord c, float near, float len, float side, float face, FaceBand band) {
    float reach = side * len;
    float t = c.pn + near * c.un;
    float v0 = side * (t - face) * band.inverse_a;
    float dv = len * c.un * band.inverse_a;
    float inside0 = 1.0 - (c.rho2 + near * near - t * t) * KERNEL_INVERSE_R2;
    float inside1 = -2.0 * reach * (near - t * c.un) * KERNEL_INVERSE_R2;
    float inside2 = -len * len * (1.0 - c.un * c.un) * KERNEL_INVERSE_R2;
    float face_w = face * (1.0 / KERNEL_R);
    float band_w = side * band.a * (1.0 / KERNEL_R);
    float stronger = band.k - 1.0;
    float sum = 0.0;
    for (int i = 0; i < FOOTPRINT_NODES; ++i) {
        float x = FOOTPRINT_NODE[FOOTPRINT_RULE + i];
        float v = v0 + dv * x;
        float b = stronger * (v - v * v);
        float w = face_w + band_w * ((v + b) / (1.0 + b));
        sum += FOOTPRINT_WEIGHT[FOOTPRINT_RULE + i] * kernel_at(inside0 + x * (inside1 + x * inside2) - w * w);
    }
    return len * sum;
}

float footprint_of_faces(float rho2, float pn, float un, float D, float D2, int faces, FaceBand band, Slice slice) {
    Chord c = chord_of(rho2, pn, un, slice);
    float sum = footprint_isotropic(rho2, slice);
    float inverse_un = 1.0 / c.un;
    float face = D;
    float first = band.first;
    float last = band.last;
    for (int i = 0; i < faces; ++i) {
        float start = max((first - c.pn) * inverse_un, c.low);
        float middle = (face - c.pn) * inverse_un;
        float end = min((last - c.pn) * inverse_un, c.high);
        float behind = max(middle, c.low);
        float before = min(middle, c.high);
        sum += edge_piece(c, before, max(before - start, 0.0), -1.0, face, band) +
               edge_piece(c, behind, max(end - behind, 0.0), 1.0, face, band) - chord_plain(c, face - band.a, face + band.a);
        face = -D2;
        first = face_first(face, band.a, band.k);
        last = face_last(face, band.a, band.k);
    }
    return max(sum, 0.0);
}

float footprint_procedural(float rho2, float pn, float un, float D, float D2, int faces, Slice slice, FootprintParams params) {
    return footprint_of_faces(rho2, pn, un, D, D2, faces, face_band(D, D2, faces, params), slice);
}

// ---- curved edges (footprints/edge_warp.cpp, procedural_footprint.cpp)

// |W(x) - x_i|^2 for a point with r2 = |x - x_i|^2 and t = n . (x - x_i).
float curved_distance2(float r2, float t, float D, float curvature, float a, float k) {
    float q = t - D;
    float e2 = max(r2 - t * t, 0.0);
    float slope = 1.0 + curvature * q;
    float root = sqrt(slope * slope + curvature * curvature * e2);
    float s = (2.0 * q + curvature * (q * q + e2)) / (root + 1.0);
    float moved = edge_warp(s, a, k) - s;
    float along = (slope * t + curvature * e2) / max(root, 1e-6);
    return max(r2 + moved * (2.0 * along + moved), 0.0);
}

// The two z on a ray at signed distance s from the edge, where A z^2 + 2 B z + C(s) = 0; both the vertex where there are none.
struct Parabola {
    float A;
    float B;
    float C;
};
struct Pair {
    float first;
    float second;
};

Pair parabola_at(Parabola p, float s, Slice clip) {
    float c = p.C - s * (2.0 + p.A * s);
    float disc = p.B * p.B - p.A * c;
    float root = sqrt(max(disc, 0.0));
    float q = -(p.B + (p.B < 0.0 ? -root : root));
    float vertex = -p.B / p.A;
    float far = disc > 0.0 ? q / p.A : vertex;
    float near = disc > 0.0 && q != 0.0 ? c / q : vertex;
    Pair z;
    z.first = clamp(min(far, near), clip.low, clip.high);
    z.second = clamp(max(far, near), clip.low, clip.high);
    return z;
}

float footprint_curved(float rho2, float pn, float un, float D, float curvature, Slice slice, FootprintParams params) {
    float a = params.half_width;
    float k = params.strength;
    // W moves no point further than the band is wide.
    float reach = sqrt(max(0.0, (KERNEL_R + a) * (KERNEL_R + a) - rho2));
    Slice clip = Slice(max(-reach, slice.low), min(reach, slice.high));
    clip.high = max(clip.high, clip.low);
    Parabola p;
    p.A = abs(curvature) < 1e-5 ? (curvature < 0.0 ? -1e-5 : 1e-5) : curvature;
    p.B = un * (1.0 - p.A * D);
    p.C = 2.0 * (pn - D) + p.A * (rho2 - 2.0 * pn * D + D * D);
    // Outside these distances W leads out of the kernel.
    float inner = min(max(-a, edge_warp_inverse(-KERNEL_R - D, a, k)), 0.0);
    float outer = max(min(a, edge_warp_inverse(KERNEL_R - D, a, k)), 0.0);
    float sum = kernel_between(rho2, clip.low, clip.high);
    Pair z0 = parabola_at(p, -a, clip);
    Pair z1 = parabola_at(p, inner, clip);
    Pair z2 = parabola_at(p, 0.0, clip);
    Pair z3 = parabola_at(p, outer, clip);
    Pair z4 = parabola_at(p, a, clip);
    // The band is met twice, on the way in and on the way out. Its two ends bound what is not plain.
    sum -= abs(kernel_between(rho2, z0.first, z4.first)) + abs(kernel_between(rho2, z0.second, z4.second));
    for (int piece = 0; piece < 4; ++piece) {
        float x = piece == 0 ? z1.first : (piece == 1 ? z2.first : (piece == 2 ? z1.second : z2.second));
        float y = piece == 0 ? z2.first : (piece == 1 ? z3.first : (piece == 2 ? z2.second : z3.second));
        float len = abs(y - x);
        float start = min(x, y);
        float part = 0.0;
        for (int i = 0; i < FOOTPRINT_NODES; ++i) {
            float z = start + len * FOOTPRINT_NODE[FOOTPRINT_RULE + i];
            part += FOOTPRINT_WEIGHT[FOOTPRINT_RULE + i] *
                    kernel(curved_distance2(rho2 + z * z, pn + z * un, D, p.A, a, k));
        }
        sum += len * part;
    }
    return max(sum, 0.0);
}

// ---- the paper's short cut

float footprint_warp2d(float rho2, float pn, float un, float D, Slice slice, FootprintParams params) {
    float s = pn - D;
    return displaced_footprint(rho2, pn, un, edge_warp(s, params.half_width, params.strength) - s, slice);
}

// ---- table (footprints/table_coordinates.h, footprint_table.h)

struct TablePoint {
    float distance;   // in layers
    float direction;  // in layers
    float sine;
    float X;
    float y;
    float base;       // base footprint
};

TablePoint table_point(float rho2, float pn, float un, float D, FootprintParams params) {
    TablePoint p;
    float a = params.half_width;
    float d = min(abs(D), KERNEL_R + a);
    float m = D < 0.0 ? -pn : pn;  // the mirror image serves D < 0
    float c = min(abs(un), 1.0);
    p.sine = sqrt(1.0 - c * c);
    float v = min(1.0, c * 0.4 / a);
    float strength = (v + params.strength * (1.0 - v)) / (1.0 + (params.strength - 1.0) * v * (1.0 - v));
    float delta = edge_warp(m - d, a, strength) - (m - d);
    float rho = sqrt(rho2);
    float x = clamp(m / max(p.sine, 1e-3), -rho, rho);
    p.X = x + p.sine * delta;
    p.y = sqrt(max(0.0, rho2 - x * x));
    p.base = displaced_footprint(rho2, m, c, delta, Slice(-1e9, 1e9));
    p.distance = d / (KERNEL_R + a) * (params.table_distances - 1.0);
    p.direction = 1.4 * c / (c + 0.4 * (1.0 + p.sine)) * (params.table_directions - 1.0);
    return p;
}

float table_texel(sampler2DArray table, float distance, float direction, float X, float y, FootprintParams params) {
    float u = 0.5 + clamp((X / params.table_extent + 1.0) * 0.5, 0.0, 1.0) * (params.table_width - 1.0);
    float v = 0.5 + clamp(y / KERNEL_R, 0.0, 1.0) * (params.table_height - 1.0);
    float layer = distance * params.table_directions + direction;
    return textureLod(table, vec3(u / params.table_width, v / params.table_height, layer), 0.0).r;
}

float footprint_table_nearest(sampler2DArray table, float rho2, float pn, float un, float D, FootprintParams params) {
    TablePoint p = table_point(rho2, pn, un, D, params);
    float i = floor(p.distance + 0.5);
    float j = floor(p.direction + 0.5);
    float shift = (i - p.distance) * (KERNEL_R + params.half_width) / (params.table_distances - 1.0) * p.sine;
    return max(0.0, p.base + table_texel(table, i, j, p.X + shift, p.y, params));
}

float footprint_table_lerp(sampler2DArray table, float rho2, float pn, float un, float D, FootprintParams params) {
    TablePoint p = table_point(rho2, pn, un, D, params);
    float i = min(floor(p.distance), params.table_distances - 2.0);
    float j = min(floor(p.direction), params.table_directions - 2.0);
    float fd = p.distance - i;
    float fc = p.direction - j;
    // Along n by the layer's offset in d: the edge stands still between layers.
    float spacing = (KERNEL_R + params.half_width) / (params.table_distances - 1.0) * p.sine;
    float X0 = p.X - fd * spacing;
    float X1 = X0 + spacing;
    float near = (1.0 - fc) * table_texel(table, i, j, X0, p.y, params) +
                 fc * table_texel(table, i, j + 1.0, X0, p.y, params);
    float far = (1.0 - fc) * table_texel(table, i + 1.0, j, X1, p.y, params) +
                fc * table_texel(table, i + 1.0, j + 1.0, X1, p.y, params);
    return max(0.0, p.base + (1.0 - fd) * near + fd * far);
}

// ---- the paper's warp (footprints/paper_warp.h, design (3)-(5))

struct PaperKnots {
    float start;  // first t of the warped unit interval
    float t1;
    float t2;
    float m1;
    float m2;
};

PaperKnots paper_knots(float D, FootprintParams params) {
    PaperKnots q;
    q.start = D < 1.0 ? 0.0 : 1.0;
    q.t1 = 0.5 - params.paper_inset;
    q.t2 = 0.5 + params.paper_inset;
    float position = clamp(D - q.start, q.t1 / 3.0 + params.paper_rise, (2.0 + q.t2) / 3.0 - params.paper_rise);
    q.m1 = position - params.paper_rise;
    q.m2 = position + params.paper_rise;
    return q;
}

// x/t of an end piece, p(x) = m - e for e in [0, m]: e = q^2 (A + B q) with q = 1 - x/t, solved by Newton's method on its square
// root, which is nearly straight.
float paper_end(float e, float t, float m) {
    float A = max(3.0 * m - t, 0.0);
    float B = t - 2.0 * m;
    float root = sqrt(max(e, 0.0));
    float q = root / sqrt(m);
    for (int i = 0; i < 4; ++i) {
        float g = sqrt(max(A + B * q, 1e-8));
        q = clamp(q - (q * g - root) / (g + 0.5 * B * q / g), 0.0, 1.0);
    }
    return 1.0 - q;
}

float rational_quadratic(float x, float x0, float x1, float y0, float y1, float s0, float s1) {
    float e = (y1 - y0) / (x1 - x0);
    float u = (x - x0) / (x1 - x0);
    float v = u * (1.0 - u);
    return y0 + (y1 - y0) * (e * u * u + s0 * v) / (e + (s0 + s1 - 2.0 * e) * v);
}

float paper_map(float x, PaperKnots q, uint smooth_curve) {
    float inside = clamp(x, 0.0, 1.0);
    float first = q.t1 * paper_end(q.m1 - inside, q.t1, q.m1);
    float last = 1.0 - (1.0 - q.t2) * paper_end(inside - q.m2, 1.0 - q.t2, 1.0 - q.m2);
    float middle = q.t1 + (q.t2 - q.t1) / 3.14159265 * acos(clamp(1.0 - 2.0 * (inside - q.m1) / (q.m2 - q.m1), -1.0, 1.0));
    float slope = (q.t2 - q.t1) / (q.m2 - q.m1);
    // Chosen between, not branched on: lavapipe makes and keeps a shader anew for every branch that a uniform decides.
    bool smoothed = smooth_curve != 0u;
    first = mix(first, rational_quadratic(inside, 0.0, q.m1, 0.0, q.t1, 1.0, slope), smoothed);
    middle = mix(middle, q.t1 + slope * (inside - q.m1), smoothed);
    last = mix(last, rational_quadratic(inside, q.m2, 1.0, q.t2, 1.0, slope, 1.0), smoothed);
    float w = inside < q.m1 ? first : (inside < q.m2 ? middle : last);
    return w + (x - inside);
}

float footprint_paper_procedural(float rho2, float pn, float un, float D, Slice slice, FootprintParams params) {
    PaperKnots q = paper_knots(D, params);
    Chord c = chord_of(rho2, pn, un, slice);
    float sum = footprint_isotropic(rho2, slice);
    int pieces = D < KERNEL_R ? 3 : 0;
    sum -= D < KERNEL_R ? chord_plain(c, q.start, q.start + 1.0) : 0.0;
    for (int i = 0; i < pieces; ++i) {
        float first = q.start + (i == 0 ? 0.0 : (i == 1 ? q.m1 : q.m2));
        float last = q.start + (i == 0 ? q.m1 : (i == 1 ? q.m2 : 1.0));
        float start = max((first - c.pn) / c.un, c.low);
        float len = max(0.0, min((last - c.pn) / c.un, c.high) - start);
        float part = 0.0;
        for (int j = 0; j < FOOTPRINT_NODES; ++j) {
            float z = start + len * FOOTPRINT_NODE[FOOTPRINT_RULE + j];
            float t = c.pn + z * c.un;
            float w = q.start + paper_map(t - q.start, q, params.paper_smooth);
            part += FOOTPRINT_WEIGHT[FOOTPRINT_RULE + j] * kernel(c.rho2 + z * z + (w - t) * (w + t));
        }
        sum += len * part;
    }
    return max(sum, 0.0);
}

float footprint_paper_warp2d(float rho2, float pn, float un, float D, Slice slice, FootprintParams params) {
    PaperKnots q = paper_knots(D, params);
    float w = q.start + paper_map(pn - q.start, q, params.paper_smooth);
    return displaced_footprint(rho2, pn, un, D < KERNEL_R ? w - pn : 0.0, slice);
}

#endif

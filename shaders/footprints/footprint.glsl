// Footprints of plain kernels and of kernels warped by the paper's curve: the float32 mirror of footprints/ (same
// names, same equations).
//
// Declares no bindings. A ray is (rho2, pn, un) with rho2 = dot(p, p), pn = dot(p, n), un = dot(u, n), all in index
// space. p: the ray's point nearest to the voxel centre, relative to it; u: its unit direction; n: the unit edge
// normal. D: distance to the edge along n, voxels. Results are integrals of K along the ray, in voxels. Every input is
// safe: no NaN for un = 0 or 1, rho2 = 0, pn beyond rho.
//
//   footprint_isotropic(rho2, slice)                        a splat without an edge
//   footprint_paper_warp2d(rho2, pn, un, D, slice, params)  --warp paper with warp2d
//   footprint_paper_procedural(rho2, pn, un, D, slice, params)  --warp paper with any other mode
//
// Kernels that faces cut are in face.glsl. Written in the subset of GLSL that is also C++
// (tests/unit/footprints_shader_test.cpp runs it): scalars, no swizzles.
#ifndef EDGESPLAT_FOOTPRINT_GLSL
#define EDGESPLAT_FOOTPRINT_GLSL
#include "shaders/footprints/slice.glsl"
#include "shaders/footprints/kernel.glsl"
#include "shaders/shared/footprint_params.h"

// Gauss-Legendre rules on [0, 1] with 4, 10 and 6 nodes, one after the other; the including shader selects one by
// NODES. No rule has a node at 1/2, where a piece switches from the tangent plane of its entry to that of its exit.
const float FOOTPRINT_NODE[20] = {
    0.0694318442, 0.3300094782, 0.6699905218, 0.9305681558, 0.0130467357, 0.0674683167, 0.1602952159, 0.2833023029, 0.4255628305,
    0.5744371695, 0.7166976971, 0.8397047841, 0.9325316833, 0.9869532643, 0.0337652429, 0.1693953068, 0.3806904070, 0.6193095930,
    0.8306046932, 0.9662347571};
const float FOOTPRINT_WEIGHT[20] = {
    0.1739274226, 0.3260725774, 0.3260725774, 0.1739274226, 0.0333356722, 0.0747256746, 0.1095431813, 0.1346333597, 0.1477621124,
    0.1477621124, 0.1346333597, 0.1095431813, 0.0747256746, 0.0333356722, 0.0856622462, 0.1803807865, 0.2339569673,
    0.2339569673, 0.1803807865, 0.0856622462};
const int FOOTPRINT_NODES = int(NODES);
const int FOOTPRINT_RULE = FOOTPRINT_NODES == 4 ? 0 : (FOOTPRINT_NODES == 10 ? 4 : 14);

// ---- plain footprints (footprints/kernel.h)

// The whole footprint has its own closed form, which is cheaper than two chords.
bool is_whole(Slice slice) { return slice.low <= -1e8 && slice.high >= 1e8; }

float footprint_isotropic(float rho2, Slice slice) {
    if (is_whole(slice)) return kernel_footprint(rho2);
    return max(0.0, kernel_between(rho2, slice.low, slice.high));
}

// Footprint at the ray's nearest point, moved by delta times the component of n perpendicular to the ray.
float displaced_footprint(float rho2, float pn, float un, float delta, Slice slice) {
    return footprint_isotropic(max(0.0, rho2 + delta * (2.0 * pn + (1.0 - un * un) * delta)), slice);
}

// ---- quadrature along the ray (footprints/procedural_footprint.cpp)

// The ray near the voxel: z = distance along the ray from p; t = coordinate along n, with the sign that makes it grow
// with z.
struct Chord {
    float rho2;
    float pn;
    float un;
    float low;   // z within R of the axis through the voxel along n; the warp W never leaves that cylinder
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

// x/t of an end piece, p(x) = m - e for e in [0, m]: e = q^2 (A + B q) with q = 1 - x/t. Solved by Newton's method on
// the square root of the equation, which is nearly linear.
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
    // Selected without a branch: lavapipe recompiles and stores a shader for every branch that depends on a uniform.
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

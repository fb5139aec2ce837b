// Footprints of plain kernels and of kernels warped by the paper's curve, in float: footprints/footprint.glsl with the paper's
// curve in few steps (footprints/paper_warp.h has it exactly). Declares no bindings. Kernels that faces cut are in
// footprints/face.glsl. Written in the subset of GLSL that is also C++ (tests/unit/footprints_shader_test.cpp runs it).
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

#include "footprints/paper_knots.glsl"

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

float paper_map(float x, PaperKnots q, FootprintParams params) {
    float inside = clamp(x, 0.0, 1.0);
    float first = q.t1 * paper_end(q.m1 - inside, q.t1, q.m1);
    float last = 1.0 - (1.0 - q.t2) * paper_end(inside - q.m2, 1.0 - q.t2, 1.0 - q.m2);
    float middle = q.t1 + (q.t2 - q.t1) / 3.14159265 * acos(clamp(1.0 - 2.0 * (inside - q.m1) / (q.m2 - q.m1), -1.0, 1.0));
    float slope = (q.t2 - q.t1) / (q.m2 - q.m1);
    // Selected without a branch: lavapipe recompiles and stores a shader for every branch that depends on a uniform.
    bool smoothed = params.paper_smooth != 0u;
    first = mix(first, rational_quadratic(inside, 0.0, q.m1, 0.0, q.t1, 1.0, slope), smoothed);
    middle = mix(middle, q.t1 + slope * (inside - q.m1), smoothed);
    last = mix(last, rational_quadratic(inside, q.m2, 1.0, q.t2, 1.0, slope, 1.0), smoothed);
    float w = inside < q.m1 ? first : (inside < q.m2 ? middle : last);
    return w + (x - inside);
}

#include "footprints/footprint.glsl"
#endif

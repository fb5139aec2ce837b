// Footprints of plain kernels and of kernels warped by the paper's curve. Written in the subset of GLSL that is C++: shaders
// include it in float, procedural_footprint.cpp in double.
//
// A ray is (rho2, pn, un) with rho2 = dot(p, p), pn = dot(p, n), un = dot(u, n), all in index space. p: the ray's point nearest
// to the voxel centre, relative to it; u: its unit direction; n: the unit edge normal. D: distance to the edge along n, voxels.
// Results are integrals of K along the ray, in voxels. Every input is safe: no NaN for un = 0 or 1, rho2 = 0, pn beyond rho.
//
//   footprint_isotropic(rho2, slice)                        a splat without an edge
//   footprint_paper_warp2d(rho2, pn, un, D, slice, params)  --warp paper with warp2d
//   footprint_paper_procedural(rho2, pn, un, D, slice, params)  --warp paper with any other mode
//
// The includer declares Slice; a rule for the interval from 0 to 1 (FOOTPRINT_NODES, FOOTPRINT_RULE, FOOTPRINT_NODE,
// FOOTPRINT_WEIGHT); and of the paper's curve paper_knots(D, params) and paper_map(x, knots, params). Include after kernel.glsl and
// PaperKnots (paper_knots.glsl).
#ifndef EDGESPLAT_PAPER_FOOTPRINT_GLSL
#define EDGESPLAT_PAPER_FOOTPRINT_GLSL

// The whole footprint has its own closed form, which is cheaper than two chords.
bool is_whole(Slice slice) { return slice.low <= -1e8 && slice.high >= 1e8; }

Real footprint_isotropic(Real rho2, Slice slice) {
    if (is_whole(slice)) return kernel_footprint(rho2);
    return max(0.0, kernel_between(rho2, slice.low, slice.high));
}

// Footprint at the ray's nearest point, moved by delta times the component of n perpendicular to the ray.
Real displaced_footprint(Real rho2, Real pn, Real un, Real delta, Slice slice) {
    return footprint_isotropic(max(0.0, rho2 + delta * (2.0 * pn + (1.0 - un * un) * delta)), slice);
}

// The ray near the voxel: z = distance along the ray from p; t = coordinate along n, with the sign that makes it grow
// with z.
struct Chord {
    Real rho2;
    Real pn;
    Real un;
    Real low;   // z within R of the axis through the voxel along n; the warp W never leaves that cylinder
    Real high;
};

Chord chord_of(Real rho2, Real pn, Real un, Slice slice) {
    Chord c;
    c.rho2 = rho2;
    c.pn = pn;
    c.un = clamp(abs(un), 1e-4, 1.0);
    Real s2 = max(1.0 - c.un * c.un, 1e-5);
    Real y2 = max(0.0, rho2 - pn * pn / s2);
    Real half_length = sqrt(max(0.0, KERNEL_R2 - y2) / s2);
    c.low = max(pn * c.un / s2 - half_length, un < 0.0 ? -slice.high : slice.low);
    c.high = max(min(pn * c.un / s2 + half_length, un < 0.0 ? -slice.low : slice.high), c.low);
    return c;
}

Real chord_plain(Chord c, Real first, Real last) {
    return kernel_between(c.rho2, clamp((first - c.pn) / c.un, c.low, c.high), clamp((last - c.pn) / c.un, c.low, c.high));
}

Real footprint_paper_procedural(Real rho2, Real pn, Real un, Real D, Slice slice, FootprintParams params) {
    PaperKnots q = paper_knots(D, params);
    Chord c = chord_of(rho2, pn, un, slice);
    Real sum = footprint_isotropic(rho2, slice);
    int pieces = D < KERNEL_R ? 3 : 0;
    sum -= D < KERNEL_R ? chord_plain(c, q.start, q.start + 1.0) : 0.0;
    for (int i = 0; i < pieces; ++i) {
        Real first = q.start + (i == 0 ? 0.0 : (i == 1 ? q.m1 : q.m2));
        Real last = q.start + (i == 0 ? q.m1 : (i == 1 ? q.m2 : 1.0));
        Real start = max((first - c.pn) / c.un, c.low);
        Real len = max(0.0, min((last - c.pn) / c.un, c.high) - start);
        Real part = 0.0;
        for (int j = 0; j < FOOTPRINT_NODES; ++j) {
            Real z = start + len * FOOTPRINT_NODE[FOOTPRINT_RULE + j];
            Real t = c.pn + z * c.un;
            Real w = q.start + paper_map(t - q.start, q, params);
            part += FOOTPRINT_WEIGHT[FOOTPRINT_RULE + j] * kernel(c.rho2 + z * z + (w - t) * (w + t));
        }
        sum += len * part;
    }
    return max(sum, 0.0);
}

Real footprint_paper_warp2d(Real rho2, Real pn, Real un, Real D, Slice slice, FootprintParams params) {
    PaperKnots q = paper_knots(D, params);
    Real w = q.start + paper_map(pn - q.start, q, params);
    return displaced_footprint(rho2, pn, un, D < KERNEL_R ? w - pn : 0.0, slice);
}

#endif

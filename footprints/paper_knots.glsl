// The knots of the paper's curve at an edge (paper_warp.h, design (3)-(5)). Written in the subset of GLSL that is C++.
#ifndef EDGESPLAT_PAPER_KNOTS_GLSL
#define EDGESPLAT_PAPER_KNOTS_GLSL

struct PaperKnots {
    Real start;  // first t of the warped unit interval
    Real t1;
    Real t2;
    Real m1;
    Real m2;
};
#endif

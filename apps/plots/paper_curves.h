// Curves of Figures 4, 6, 7 and 8 of Huang, Crawfis, Stredney 1998, computed with the renderer's functions.
#pragma once

#include <vector>

#include "engine/image/gnuplot.h"
#include "footprints/paper_warp.h"

namespace edgesplat {

/// Two-tone data in one dimension: `left` up to voxel 0, `right` from voxel 1. The edge is at p(1/2) = (m1 + m2)/2.
struct CurveExample {
    PaperProfile profile{0.2, 0.8, 0.3, 0.4};
    double left = 1, right = 0.25;

    double edge() const { return (profile.m1 + profile.m2) / 2; }
    PaperProfile smooth() const;  ///< the profile's smooth variant
};

/// The weighted kernel of voxel i (-1, 0, 1, 2: the paper's splats 0 to 3) at x; pass the warped x for a warped kernel.
double weighted_kernel(const CurveExample& example, int i, double x);

/// The reconstruction at x: the sum of the weighted kernels of all voxels.
double reconstruction(const CurveExample& example, double x);

/// The reconstruction at x with kernels cut by a face at the edge. Only kernels on x's side contribute; they are
/// sampled at least FACE_DEPTH away from the edge.
double cut_reconstruction(const CurveExample& example, double x);

/// Figures 4, 6, 7 and 8, in that order.
std::vector<Plot> paper_plots(const CurveExample& example);

}  // namespace edgesplat

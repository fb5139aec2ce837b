// Footprints of plain kernels and of those that the paper's curve warps: the integral along a viewing ray, exactly (the
// oracle) and by the rules the shaders use.
//
// The kernel of a voxel at the origin is K(|W(x)|), W moving x along n only. So a ray matters through three numbers,
// and a footprint is a function of them and of the edge. Values are integrals of K along the ray, in 1/voxel^2.
#pragma once

#include <limits>

#include "footprints/kernel.h"
#include "footprints/paper_warp.h"

namespace edgesplat {

/// A ray seen from a voxel: p its point nearest to the voxel centre (relative to it), u its unit direction, n the unit
/// edge normal. pn^2 <= rho2 (1 - un^2) holds for every real ray; rounding beyond is tolerated.
struct Ray {
    double rho2 = 0;  ///< |p|^2, voxels^2
    double pn = 0;    ///< p . n, voxels
    double un = 0;    ///< u . n, [-1, 1]
};

/// A piece of a ray: z from `low` to `high`, voxels along u from p. A sheet's share of a footprint.
struct Slice {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
};

/// The plain footprint's share of a slice.
double sliced_kernel_footprint(double rho2, const Slice& slice, const Kernel& k = kKernel);

/// The ray of design (8): n = (sqrt(1-c^2), 0, c), u = z, through (x, y).
Ray ray_through(double x, double y, double c);

/// Design (8) to an absolute 1e-10: panels split at the knots of the profile and the borders of the support, each
/// refined until it no longer changes.
double exact_footprint(const Ray& ray, const PaperEdge& edge);

/// As the shader computes it: in closed form outside the warped interval, and Gauss-Legendre with `nodes` (4 or 10)
/// nodes per piece of the profile within.
double procedural_footprint(const Ray& ray, const PaperEdge& edge, int nodes = 10, const Slice& slice = {});

/// The paper's short cut: the two-dimensional footprint, warped by the projected edge. The displacement is that of the
/// point p, shortened by the projection of n: the edge stands at D/sin(theta), its strength fades to 1 as n turns along
/// the ray.
double warp2d_footprint(const Ray& ray, const PaperEdge& edge, const Slice& slice = {});

}  // namespace edgesplat

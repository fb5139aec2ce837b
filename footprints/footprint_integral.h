// Footprints of plain kernels, and of kernels that the paper's curve warps: the exact integral along a viewing ray (the
// oracle), and the rules of the shaders.
//
// The kernel of a voxel at the origin is K(|W(x)|); W moves x along n only. So a footprint is a function of the edge
// and of three numbers of the ray. Values are integrals of K along the ray, in 1/voxel^2.
#pragma once

#include <limits>

#include "footprints/kernel.h"
#include "footprints/paper_warp.h"

namespace edgesplat {

/// A ray, relative to a voxel: p its point nearest to the voxel centre, u its unit direction, n the unit edge normal.
/// pn^2 <= rho2 (1 - un^2) holds for every real ray; violations by rounding are tolerated.
struct Ray {
    double rho2 = 0;  ///< |p|^2, voxels^2
    double pn = 0;    ///< p . n, voxels
    double un = 0;    ///< u . n, [-1, 1]
};

/// A piece of a ray: z from `low` to `high`, voxels along u from p. For example the part inside a sheet.
struct Slice {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
};

/// The plain footprint over a slice.
double sliced_kernel_footprint(double rho2, const Slice& slice, const Kernel& k = kKernel);

/// The ray through (x, y) with u = z, for n = (sqrt(1-c^2), 0, c).
Ray ray_through(double x, double y, double c);

/// The exact footprint to an absolute 1e-10. Panels are split at the knots of the profile and the borders of the
/// support, and refined until they no longer change.
double exact_footprint(const Ray& ray, const PaperEdge& edge);

/// The footprint as the shader computes it: in closed form outside the warped interval, inside it by Gauss-Legendre
/// with `nodes` (4 or 10) nodes per piece of the profile.
double procedural_footprint(const Ray& ray, const PaperEdge& edge, int nodes = 10, const Slice& slice = {});

/// The paper's approximation: the two-dimensional footprint, warped by the projected edge. The displacement is that of
/// the point p, shortened by the projection of n. So the edge lies at D/sin(theta), and its strength fades to 1 as n
/// turns along the ray.
double warp2d_footprint(const Ray& ray, const PaperEdge& edge, const Slice& slice = {});

}  // namespace edgesplat

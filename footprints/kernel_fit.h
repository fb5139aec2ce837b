// Finds K7: the polynomial in w with the smallest ripple.
#pragma once

#include "footprints/kernel.h"

namespace edgesplat {

/// The kernel of that radius, 1 to 2 voxels. Solves the linear program: minimise the largest |lattice sum - 1| over a
/// grid of `steps` (4 to 64) points per half voxel, subject to K increasing in w (so falling with r) and integral 1.
/// There is no term below w^2: K is C1 at its end.
Kernel fit_kernel(int steps, double radius = kKernelRadius);

}  // namespace edgesplat

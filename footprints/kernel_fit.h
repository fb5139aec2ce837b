// How K7 was found: the polynomial in w of smallest ripple.
#pragma once

#include "footprints/kernel.h"

namespace edgesplat {

/// Solves the linear program: minimise the largest |lattice sum - 1| over a grid of `steps` (4 to 64) points per half
/// voxel, subject to K increasing in w (so falling with r) and integral 1. No term below w^2: K is C1 where it ends.
KernelCoefficients fit_kernel(int steps);

}  // namespace edgesplat

// Weights of warped kernels by their distance to the edge, so that what one side of an edge draws reaches up to it.
//
// Both sides together sum to one. One side alone does so only on average: the excess of its line integrals over what
// lies on that side goes up and down with where the lattice stands to the edge, by up to .06 voxel with the default
// band. A voxel that nears the edge leaves the sum at once, with all of its kernel. Weights that fade it out before,
// and give what goes to those behind it, make the excess ten times as small.
#pragma once

#include <array>

#include "footprints/edge_warp.h"

namespace edgesplat {

constexpr int kEdgeWeightSteps = 12;
constexpr double kEdgeWeightReach = 2.4;  ///< voxels from the edge, from where on the weight is 1

/// Weight of a kernel at the distances 0, reach / steps, ... reach; linear between them, the first below 0.
using EdgeWeights = std::array<double, kEdgeWeightSteps + 1>;

/// The weights with the least squares of the excess, over half spaces of every orientation and rays through them. The
/// same on every call; takes some 50 ms for a band that has not been asked for before.
EdgeWeights edge_weights(const EdgeBand& band);

double edge_weight(double distance, const EdgeWeights& weights);

/// Of a kernel between two faces: the product, none where the wall is 2.5 voxels thick or less, all from 3 on.
double edge_weight(double distance, double second_distance, const EdgeBand& band, const EdgeWeights& weights);

}  // namespace edgesplat

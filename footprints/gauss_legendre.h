// Gauss-Legendre rules on [0, 1].
#pragma once

#include <cstddef>
#include <vector>

namespace edgesplat {

struct QuadratureRule {
    std::vector<double> nodes;    ///< in (0, 1), ascending
    std::vector<double> weights;  ///< sum 1; of a crowded rule nearly
    std::size_t size() const { return nodes.size(); }
};

/// The rule of n >= 1 nodes: exact for polynomials of degree 2n - 1.
QuadratureRule gauss_legendre(int n);

/// The rule with its nodes nearer to 0 by the Moebius map x / (2 - x): for integrands that are steep there.
QuadratureRule crowded(const QuadratureRule& rule);

}  // namespace edgesplat

// Gauss-Legendre rules on [0, 1].
#pragma once

#include <cstddef>
#include <vector>

namespace edgesplat {

struct QuadratureRule {
    std::vector<double> nodes;    ///< in (0, 1), ascending
    std::vector<double> weights;  ///< sum 1
    std::size_t size() const { return nodes.size(); }
};

/// The rule of n >= 1 nodes: exact for polynomials of degree 2n - 1.
QuadratureRule gauss_legendre(int n);

/// The same rule, computed once, for 1 to 32 nodes. Throws std::out_of_range.
const QuadratureRule& kept_gauss_legendre(int n);

}  // namespace edgesplat

#include "engine/reference/ray_quadrature.h"

#include "footprints/gauss_legendre.h"

namespace edgesplat::reference {

CollocationRule::CollocationRule() {
    const QuadratureRule gauss = gauss_legendre(static_cast<int>(kNodes));
    std::copy(gauss.nodes.begin(), gauss.nodes.end(), nodes.begin());
    std::copy(gauss.weights.begin(), gauss.weights.end(), weights.begin());
    const auto lagrange = [&](std::size_t j, double x) {
        double product = 1;
        for (std::size_t m = 0; m < kNodes; ++m)
            if (m != j) product *= (x - nodes[m]) / (nodes[j] - nodes[m]);
        return product;
    };
    for (std::size_t i = 0; i < kNodes; ++i)
        for (std::size_t j = 0; j < kNodes; ++j)
            for (std::size_t m = 0; m < kNodes; ++m)
                partial[i][j] += nodes[i] * weights[m] * lagrange(j, nodes[i] * nodes[m]);
}

const CollocationRule& collocation_rule() {
    static const CollocationRule rule;
    return rule;
}

}  // namespace edgesplat::reference

#include "footprints/gauss_legendre.h"

#include <cmath>
#include <map>
#include <numbers>

namespace edgesplat {

QuadratureRule gauss_legendre(int n) {
    QuadratureRule rule;
    for (int i = n - 1; i >= 0; --i) {
        double x = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5));  // near the root; Newton converges from here
        double slope = 1;
        for (int step = 0; step < 20; ++step) {
            double p = 1, previous = 0;  // Legendre P_j by its three-term recurrence
            for (int j = 1; j <= n; ++j) {
                const double next = ((2 * j - 1) * x * p - (j - 1) * previous) / j;
                previous = p;
                p = next;
            }
            slope = n * (x * p - previous) / (x * x - 1);
            const double change = p / slope;
            x -= change;
            if (std::abs(change) < 1e-16) break;
        }
        rule.nodes.push_back((x + 1) / 2);
        rule.weights.push_back(1 / ((1 - x * x) * slope * slope));
    }
    return rule;
}

const QuadratureRule& kept_gauss_legendre(int n) {
    static const std::map<int, QuadratureRule> rules = [] {
        std::map<int, QuadratureRule> made;
        for (int nodes = 1; nodes <= 32; ++nodes)
            made.emplace(nodes, gauss_legendre(nodes));
        return made;
    }();
    return rules.at(n);
}

}  // namespace edgesplat

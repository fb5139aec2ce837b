#include "engine/reference/quadrics.h"

#include <algorithm>
#include <cmath>

#include "shaders/shared/limits.h"

namespace edgesplat::reference {

namespace {

using glm::dmat3;
using glm::dvec3;

constexpr auto kFitRidge = static_cast<double>(shader::FIT_RIDGE);

/// Axes of a symmetric matrix by Jacobi rotations. `a` becomes diagonal, with the eigenvalues.
dmat3 axes_of(dmat3& a) {
    dmat3 axes(1);
    for (int sweep = 0; sweep < 12; ++sweep) {
        for (int p = 0; p < 2; ++p) {
            for (int q = p + 1; q < 3; ++q) {
                if (a[p][q] == 0) continue;
                const double theta = 0.5 * (a[q][q] - a[p][p]) / a[p][q];
                const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::hypot(theta, 1.0));
                const double c = 1 / std::hypot(t, 1.0), s = t * c;
                dmat3 turn(1);
                turn[p][p] = turn[q][q] = c;
                turn[q][p] = s;
                turn[p][q] = -s;
                a = glm::transpose(turn) * a * turn;
                axes = axes * turn;
            }
        }
    }
    return axes;
}

}  // namespace

Quadric quadric_of(const Moments& sums) {
    const double share = 1 / std::max(sums.weight, 1e-20);
    const dvec3 r = share * sums.r, m = share * sums.m;
    const dmat3 turns = share * sums.turns - glm::outerProduct(m, r);
    dmat3 scatter = share * sums.places - glm::outerProduct(r, r);
    const dmat3 axes = axes_of(scatter);
    dmat3 turned = glm::transpose(axes) * (turns + glm::transpose(turns)) * axes;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            turned[i][j] /= std::max(scatter[i][i], 0.0) + std::max(scatter[j][j], 0.0) + 2.0 * kFitRidge;
    Quadric q;
    q.h = axes * turned * glm::transpose(axes);
    q.g = m - q.h * r;
    double bent = 0;
    for (int i = 0; i < 3; ++i)
        bent += share * glm::dot(q.h[i], sums.places[i]);
    q.c = -glm::dot(q.g, r) - 0.5 * bent;
    return q;
}

}  // namespace edgesplat::reference

// Fits a quadric to points of a surface and their normals (docs/method/faces.md, 2).
#pragma once

#include <glm/glm.hpp>

namespace edgesplat::reference {

/// Weighted sums over points with normals.
struct Moments {
    double weight = 0;
    glm::dvec3 r{0}, m{0};
    glm::dmat3 places{0}, turns{0};
    void add(const glm::dvec3& at, const glm::dvec3& normal, double w) {
        weight += w;
        r += w * at;
        m += w * normal;
        places += w * glm::outerProduct(at, at);
        turns += w * glm::outerProduct(normal, at);
    }
};

struct Quadric {
    double c = 0;
    glm::dvec3 g{0};
    glm::dmat3 h{0};
    double at(const glm::dvec3& r) const { return c + glm::dot(g, r) + 0.5 * glm::dot(r, h * r); }
    glm::dvec3 slope(const glm::dvec3& r) const { return g + h * r; }
};

/// The quadric that fits the points best, by least squares.
Quadric quadric_of(const Moments& sums);

}  // namespace edgesplat::reference

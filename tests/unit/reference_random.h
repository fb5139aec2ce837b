// Random numbers and vectors for tests of the geometry.
#pragma once

#include <glm/glm.hpp>
#include <random>

namespace edgesplat::testing_random {

class Random {
  public:
    explicit Random(unsigned seed = 20) : engine_(seed) {}

    double operator()(double low, double high) { return std::uniform_real_distribution(low, high)(engine_); }
    /// Components between -most and most.
    glm::dvec3 vector(double most) { return {(*this)(-most, most), (*this)(-most, most), (*this)(-most, most)}; }
    glm::dvec3 direction() {
        glm::dvec3 v(0);
        while (!(glm::length(v) > 0.1 && glm::length(v) < 1))
            v = vector(1);
        return glm::normalize(v);
    }
    /// A point across u, as rays are described.
    glm::dvec3 across(const glm::dvec3& u, double most) {
        const glm::dvec3 v = most * direction();
        return v - glm::dot(v, u) * u;
    }

  private:
    std::mt19937 engine_;
};

}  // namespace edgesplat::testing_random

// Random numbers and directions that are the same with every standard library.
#pragma once

#include <glm/glm.hpp>
#include <random>

namespace edgesplat::viewer_test {

class Random {
  public:
    explicit Random(unsigned seed) : engine_(seed) {}

    double operator()(double low, double high) {
        return low + (high - low) * (static_cast<double>(engine_()) / 4294967296.0);
    }
    glm::dvec3 in(const glm::dvec3& low, const glm::dvec3& high) {
        const double x = (*this)(low.x, high.x), y = (*this)(low.y, high.y), z = (*this)(low.z, high.z);
        return {x, y, z};
    }
    glm::dvec3 direction() {
        for (;;) {
            const glm::dvec3 v = in(glm::dvec3(-1), glm::dvec3(1));
            const double r = glm::length(v);
            if (r > 0.1 && r < 1) return v / r;
        }
    }

  private:
    std::mt19937 engine_;
};

}  // namespace edgesplat::viewer_test

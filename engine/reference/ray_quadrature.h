// Integrates emission and absorption along a ray, dC = T sigma c dt and dT = -T sigma dt, to a tolerance
// (docs/method/reference.md).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

namespace edgesplat::reference {

/// Absorption and emission at a point of a ray, per unit of t.
struct Density {
    double extinction = 0;
    glm::dvec3 emission{0};  ///< extinction times colour
};

/// A segment of a ray, composited from its beginning.
struct Stretch {
    double tau = 0;
    glm::dvec3 color{0};  ///< composited within the segment
};

/// The segment `near` with `far` behind it.
inline Stretch joined(const Stretch& near, const Stretch& far) {
    return {near.tau + far.tau, near.color + std::exp(-near.tau) * far.color};
}

/// Gauss nodes on [0, 1] with weights. `partial`: weights of the integral from 0 to each node of the polynomial through
/// all values.
struct CollocationRule {
    static constexpr std::size_t kNodes = 4;
    std::array<double, kNodes> nodes{}, weights{};
    std::array<std::array<double, kNodes>, kNodes> partial{};  ///< [node][value]
    CollocationRule();
};
const CollocationRule& collocation_rule();

/// The tolerance of a ray's integral.
struct Accuracy {
    double tolerance = 1e-4;  ///< of the whole ray
    double length = 1;        ///< of the whole ray, > 0, in t
    bool tau_only = false;    ///< nothing is occluded; the tolerance is relative to tau where tau > 1
};

/// The integral along a ray, from the eye to the current point.
struct RaySum {
    glm::dvec3 color{0};  ///< premultiplied
    double tau = 0;
    double transmittance = 1;  ///< exp(-tau)
    double error = 0;          ///< sum of the changes by the last halving of each panel: usually above the true error
    std::uint64_t samples = 0;
};

constexpr int kDeepestPanel = 24;  ///< largest number of halvings of a panel

/// Adds [begin, begin + length] to `sum`. Panels are halved until their part of the pixel changes by less than their
/// share of the tolerance. `density(t)` returns a Density.
template <typename At>
class PanelIntegrator {
  public:
    PanelIntegrator(const At& density, const Accuracy& accuracy, RaySum& sum)
        : density_(density), accuracy_(accuracy), sum_(sum) {}

    void add(double begin, double length) { refine(begin, length, stretch(begin, length), 0); }

  private:
    Stretch stretch(double begin, double length) {
        constexpr std::size_t n = CollocationRule::kNodes;
        const CollocationRule& rule = collocation_rule();
        std::array<Density, n> at;
        for (std::size_t i = 0; i < n; ++i)
            at[i] = density_(begin + length * rule.nodes[i]);
        sum_.samples += n;
        Stretch result;
        for (std::size_t i = 0; i < n; ++i) {
            double in_front = 0;
            for (std::size_t j = 0; j < n; ++j)
                in_front += rule.partial[i][j] * at[j].extinction;
            result.tau += length * rule.weights[i] * at[i].extinction;
            result.color += length * rule.weights[i] * std::exp(-length * in_front) * at[i].emission;
        }
        return result;
    }

    void refine(double begin, double length, const Stretch& whole, int depth) {
        const double half = length / 2;
        const Stretch near = stretch(begin, half);
        const Stretch far = stretch(begin + half, half);
        const Stretch both = joined(near, far);
        // Half of the tolerance is distributed by length, half by the opacity that a panel adds to the pixel.
        const double share = length / accuracy_.length;
        double change = 0;
        double part = 0;
        if (accuracy_.tau_only) {
            change = std::abs(both.tau - whole.tau);
            part = both.tau;
        } else {
            const glm::dvec3 color = glm::abs(both.color - whole.color);
            const double opacity = std::abs(std::exp(-both.tau) - std::exp(-whole.tau));
            change = sum_.transmittance * std::max({color.x, color.y, color.z, opacity});
            part = sum_.transmittance * -std::expm1(-both.tau);
        }
        if (change <= accuracy_.tolerance * (share + part) / 2 || depth >= kDeepestPanel) {
            sum_.color += sum_.transmittance * both.color;
            sum_.tau += both.tau;
            sum_.transmittance *= std::exp(-both.tau);
            sum_.error += change;
            return;
        }
        refine(begin, half, near, depth + 1);
        refine(begin + half, half, far, depth + 1);
    }

    const At& density_;
    const Accuracy& accuracy_;
    RaySum& sum_;
};

}  // namespace edgesplat::reference

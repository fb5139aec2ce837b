#include "engine/reference/creases.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "shaders/shared/limits.h"

namespace edgesplat::reference {

namespace {

using glm::dvec3;
using Crease = VoxelEdge::Crease;

constexpr auto kRadius = static_cast<double>(shader::CREASE_RADIUS);
constexpr auto kTurned = static_cast<double>(shader::CREASE_TURNED);
constexpr auto kAlike = static_cast<double>(shader::CREASE_ALIKE);
constexpr auto kBehind = static_cast<double>(shader::CREASE_BEHIND);

struct PlaneFit {
    Crease plane;
    dvec3 place{0};
    bool found = false;
};

class Fit {
  public:
    Fit(std::span<const Surfel> surfels, const dvec3& middle, bool upper)
        : surfels_(surfels), middle_(middle), upper_(upper) {}

    /// The normal that is least like both.
    dvec3 most_different(const dvec3& a, const dvec3& b) const {
        dvec3 best(0);
        double least = kTurned;
        for (const Surfel& s : surfels_) {
            const double like = std::max(glm::dot(s.n, a), glm::dot(s.n, b));
            // Of what differs as much the first is taken, whichever way numbers are rounded.
            if (!(weight(s) > 0.02) || !(like < least - 1e-4)) continue;
            least = like;
            best = s.n;
        }
        return best;
    }

    PlaneFit plane(const dvec3& seed) const {
        PlaneFit fit;
        fit.plane.n = seed;
        for (int step = 0; step < shader::CREASE_STEPS; ++step) {
            dvec3 normals(0), places(0);
            double sum = 0;
            for (const Surfel& s : surfels_) {
                const double w = weight(s) * std::max(glm::dot(s.n, fit.plane.n) - kAlike, 0.0) / (1 - kAlike);
                normals += w * s.n;
                places += w * s.at;
                sum += w;
            }
            if (!(sum > 0.05)) return {};
            fit.plane.n = glm::normalize(normals);
            fit.place = places / sum;
        }
        fit.plane.D = glm::dot(fit.plane.n, fit.place);
        fit.found = true;
        return fit;
    }

  private:
    double weight(const Surfel& s) const {
        const dvec3 r = s.at - middle_;
        const double w = std::max(1 - glm::dot(r, r) / (kRadius * kRadius), 0.0);
        return s.upper == upper_ ? w * w : 0;
    }

    std::span<const Surfel> surfels_;
    dvec3 middle_;
    bool upper_;
};

}  // namespace

double CreasePlanes::off(const dvec3& r) const {
    double most = -std::numeric_limits<double>::infinity();
    for (int k = 0; k < count; ++k)
        most = std::max(
            most, glm::dot(planes.at(static_cast<std::size_t>(k)).n, r) - planes.at(static_cast<std::size_t>(k)).D);
    return most;
}

CreasePlanes crease_planes(std::span<const Surfel> surfels, const dvec3& middle, const dvec3& n, bool upper) {
    const Fit fit(surfels, middle, upper);
    const dvec3 a = fit.most_different(n, n);
    if (a == dvec3(0)) return {};
    const dvec3 b = fit.most_different(a, a);
    if (b == dvec3(0)) return {};
    const dvec3 c = fit.most_different(a, b);
    std::array<PlaneFit, 3> fits;
    std::size_t count = 0;
    for (const dvec3& seed : {a, b, c}) {
        if (seed == dvec3(0)) continue;
        fits.at(count) = fit.plane(seed);
        if (!fits.at(count++).found) return {};
    }
    // Matter lies inside of all of them: where a crease is hollow, a plane cuts what is there. Planes that face away
    // from each other are a wall's.
    for (std::size_t k = 0; k < count; ++k)
        for (std::size_t l = 0; l < count; ++l) {
            if (k == l) continue;
            const Crease& plane = fits.at(k).plane;
            if (!(glm::dot(plane.n, fits.at(l).place) - plane.D < -kBehind)) return {};
            if (glm::dot(plane.n, fits.at(l).plane.n) < -0.5) return {};
        }
    CreasePlanes found{static_cast<int>(count), {fits[0].plane, fits[1].plane, fits[2].plane}};
    for (std::size_t k = 1; k < count; ++k)
        for (std::size_t l = k; l > 0 && found.planes.at(l).D < found.planes.at(l - 1).D - 1e-4; --l)
            std::swap(found.planes.at(l), found.planes.at(l - 1));
    return found;
}

}  // namespace edgesplat::reference

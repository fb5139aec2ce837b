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
constexpr auto kRounded = static_cast<double>(shader::CREASE_ROUNDED);
constexpr auto kSpread = static_cast<double>(shader::CREASE_SPREAD);
constexpr auto kAlike = static_cast<double>(shader::CREASE_ALIKE);
constexpr auto kBehind = static_cast<double>(shader::CREASE_BEHIND);

struct PlaneFit {
    Crease plane;
    dvec3 place{0};
    bool found = false;
};

class Fit {
  public:
    Fit(std::span<const Surfel> surfels, const Surfel& nearest) : surfels_(surfels), nearest_(nearest) {}

    /// The normal least like the nearest surfel's; 0 if all are too similar.
    dvec3 most_different() const {
        return least_like(kRounded, [this](const dvec3& n) { return glm::dot(n, nearest_.n); });
    }
    /// The normal least like a and b; 0 if all are too similar. Normals between kRounded and kAlike are excluded: they
    /// only round the transition between two planes.
    dvec3 most_different(const dvec3& a, const dvec3& b) const {
        return least_like(kTurned, [&](const dvec3& n) {
            const double seen = glm::dot(n, nearest_.n);
            if (seen > kRounded && seen < kAlike) return 1.0;
            return std::max(glm::dot(n, a), glm::dot(n, b));
        });
    }

    PlaneFit plane(const dvec3& seed) const {
        PlaneFit fit;
        fit.plane.n = seed;
        for (int step = 0; step < shader::CREASE_STEPS; ++step) {
            dvec3 normals(0), places(0);
            glm::dmat3 spread(0);
            double sum = 0;
            for (const Surfel& s : surfels_) {
                const double w = weight(s) * std::max(glm::dot(s.n, fit.plane.n) - kAlike, 0.0) / (1 - kAlike);
                normals += w * s.n;
                places += w * s.at;
                spread += w * glm::outerProduct(s.at, s.at);
                sum += w;
            }
            if (!(sum > 0.05)) return {};
            fit.place = places / sum;
            // The spline's normals are tilted beside creases, since it rounds them; positions are more reliable.
            const glm::dmat3 about = spread / sum - glm::outerProduct(fit.place, fit.place) + glm::dmat3(kSpread);
            fit.plane.n = glm::normalize(glm::inverse(about) * normals);
        }
        fit.plane.D = glm::dot(fit.plane.n, fit.place);
        fit.found = true;
        return fit;
    }

  private:
    template <typename Like>
    dvec3 least_like(double least, const Like& like_of) const {
        dvec3 best(0);
        for (const Surfel& s : surfels_) {
            const double like = like_of(s.n);
            // Among equals take the first, whatever the rounding.
            if (!(weight(s) > 0.02) || !(like < least - 1e-4)) continue;
            least = like;
            best = s.n;
        }
        return best;
    }

    double weight(const Surfel& s) const {
        const dvec3 r = s.at - nearest_.at;
        const double w = std::max(1 - glm::dot(r, r) / (kRadius * kRadius), 0.0);
        return s.upper == nearest_.upper ? w * w : 0;
    }

    std::span<const Surfel> surfels_;
    Surfel nearest_;
};

}  // namespace

double CreasePlanes::off(const dvec3& r) const {
    double most = -std::numeric_limits<double>::infinity();
    for (int k = 0; k < count; ++k)
        most = std::max(
            most, glm::dot(planes.at(static_cast<std::size_t>(k)).n, r) - planes.at(static_cast<std::size_t>(k)).D);
    return most;
}

CreasePlanes crease_planes(std::span<const Surfel> surfels, const Surfel& nearest) {
    const Fit fit(surfels, nearest);
    const dvec3 a = fit.most_different();
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
    // Matter must lie inside all planes: at a hollow crease a plane would cut matter away. Planes that face away from
    // each other belong to a wall.
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

Crease square_to(const dvec3& n, const dvec3& crease, double distance, bool turned) {
    return {(turned ? -1.0 : 1.0) * glm::normalize(glm::cross(n, crease)), distance};
}

Crease corner_of(const CreasePlanes& planes) {
    if (planes.count < 3) return {};
    const auto& [first, second, third] = planes.planes;
    const double like = glm::dot(glm::normalize(glm::cross(first.n, second.n)), third.n);
    const bool kept = std::abs(like) > static_cast<double>(shader::CORNER_SQUARE) && third.D > 0 &&
                      third.D < static_cast<double>(shader::CREASE_REACH);
    return kept ? square_to(first.n, second.n, third.D, like < 0) : Crease{};
}

}  // namespace edgesplat::reference

// The warp around curved edges: what it becomes without curvature, that neighbours share it, how far it reaches.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <stdexcept>

#include "footprints/edge_warp.h"
#include "footprints/kernel.h"

namespace edgesplat {
namespace {

constexpr double kR = kKernelRadius;
using Vector = std::array<double, 3>;

double dot(const Vector& a, const Vector& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// a + s b.
Vector sum(const Vector& a, double s, const Vector& b) {
    return {a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]};
}

Vector random_unit(std::mt19937& random) {
    std::normal_distribution<> normal;
    const Vector v = {normal(random), normal(random), normal(random)};
    return sum({0, 0, 0}, 1 / std::sqrt(dot(v, v)), v);
}

/// What a voxel at `at` knows of a sphere around the origin: the normal from its own side across the surface, and the
/// edge.
struct Known {
    Vector n;
    Edge edge;
};

Known sphere_seen_from(const Vector& at, double radius, const EdgeBand& band) {
    const double away = std::sqrt(dot(at, at));
    const double side = away < radius ? 1 : -1;
    return {sum({0, 0, 0}, side / away, at), {std::abs(away - radius), band, INFINITY, side / radius}};
}

/// |W(x) - at|^2 as that voxel has it.
double seen_distance2(const Vector& x, const Vector& at, const Known& known) {
    const Vector r = sum(x, -1, at);
    return warped_distance2(dot(r, r), dot(r, known.n), known.edge);
}

TEST(CurvedWarp, BecomesThePlanesAsTheCurvatureGoes) {
    std::mt19937 random(1);
    std::uniform_real_distribution<> distance(-3.2, 3.2), along(-2.5, 2.5), across(0, 2);
    for (int i = 0; i < 2000; ++i) {
        const EdgeBand band = {i % 2 == 0 ? 1.6 : 0.8, i % 3 == 0 ? 4.0 : 16.0};
        const double d = distance(random), t = along(random), e = across(random);
        const double plane = warped_distance2(t * t + e * e, t, {d, band});
        EXPECT_NEAR(plane, std::pow(warped_coordinate(t, {d, band}), 2) + e * e, 1e-12);
        // A sphere of curvature c leaves its plane by c e^2 / 2 <= 2c, and W stretches that by k; a point moves along a
        // normal that is turned by c e. So the difference falls in proportion to c.
        for (const double c : {1e-4, 1e-6, 1e-8})
            for (const double sign : {-1.0, 1.0}) {
                const double curved = warped_distance2(t * t + e * e, t, {d, band, INFINITY, sign * c});
                ASSERT_NEAR(curved, plane, 200 * c) << "D " << d << " t " << t << " e " << e << " c " << sign * c;
            }
    }
}

TEST(CurvedWarp, NeighboursOfOneSphereShareOneWarp) {
    std::mt19937 random(2);
    std::uniform_real_distribution<> off(-2.9, 2.9), size(3, 10), around(-1.2, 1.2);
    const EdgeBand band;
    double farthest = 0;
    for (int i = 0; i < 3000; ++i) {
        const double radius = size(random);
        // A point of the warped band and where W takes it: along the radius by M(s) - s.
        const Vector u = random_unit(random);
        const double s = band.half_width * around(random);
        const Vector x = sum({0, 0, 0}, radius + s, u);
        const Vector warped = sum({0, 0, 0}, radius + edge_warp(s, band), u);
        // Two voxels near by, wherever they are: the one has to know of that point what the other knows.
        for (int j = 0; j < 2; ++j) {
            const Vector at = sum(sum(x, 0, x), off(random), random_unit(random));
            if (dot(at, at) < 0.01) continue;  // at the centre no direction is the normal
            const Vector r = sum(warped, -1, at);
            const double seen = seen_distance2(x, at, sphere_seen_from(at, radius, band));
            ASSERT_NEAR(seen, dot(r, r), 1e-9) << "radius " << radius << " s " << s;
            farthest = std::max(farthest, std::abs(edge_warp(s, band) - s));
        }
    }
    EXPECT_GT(farthest, 0.9) << "nothing was warped";
}

TEST(CurvedWarp, KernelsAroundSpheresStillSumToOne) {
    std::mt19937 random(3);
    std::uniform_real_distribution<> inside_band(-1.6, 1.6), centre(-0.5, 0.5);
    double plane_form = 0;
    for (const double radius : {3.0, 4.0, 5.5, 7.0, 10.0}) {
        double worst = 0;
        for (int i = 0; i < 150; ++i) {
            // The lattice is moved instead of the sphere.
            const Vector shift = {centre(random), centre(random), centre(random)};
            const Vector x = sum({0, 0, 0}, radius + inside_band(random), random_unit(random));
            double all = 0, all_planes = 0;
            for (int j = 0; j < 9 * 9 * 9; ++j) {
                const Vector step = {j % 9 - 4.0, j / 9 % 9 - 4.0, j / 81 - 4.0};
                Vector at;
                for (std::size_t c = 0; c < 3; ++c)
                    at[c] = std::round(x[c] - shift[c]) + step[c] + shift[c];
                if (dot(at, at) < 1e-6) continue;
                Known known = sphere_seen_from(at, radius, {});
                all += kernel(seen_distance2(x, at, known));
                known.edge.curvature = 0;
                all_planes += kernel(seen_distance2(x, at, known));
            }
            worst = std::max(worst, std::abs(all - 1));
            if (radius == 3) plane_form = std::max(plane_form, std::abs(all_planes - 1));
        }
        // W is one to one, so this is the kernel's own ripple at W(x): the same bound as at planes.
        EXPECT_LE(worst, 2e-4) << "radius " << radius;
    }
    EXPECT_GT(plane_form, 0.1) << "tangent planes would have done";
}

TEST(CurvedWarp, ACentreWithinReachGivesNumbers) {
    for (const double c : {-0.5, -0.3, 0.3, 0.5})
        for (double t = -4; t <= 4; t += 0.25)
            for (double e = 0; e <= 3; e += 0.25)
                for (double d = -3.2; d <= 3.2; d += 0.4) {
                    const double r2 = warped_distance2(t * t + e * e, t, {d, {}, INFINITY, c});
                    ASSERT_TRUE(r2 >= 0 && r2 < 100) << r2 << " at " << t << " " << e << " D " << d << " c " << c;
                }
    // On the centre itself: t = D - 1/c, e = 0.
    EXPECT_TRUE(std::isfinite(warped_distance2(2.25, -1.5, {0.5, {}, INFINITY, 0.5})));
}

TEST(CurvedSupport, HoldsEveryPointOfTheKernel) {
    std::mt19937 random(4);
    std::uniform_real_distribution<> part(0, 1);
    for (const EdgeBand& band : {EdgeBand{}, EdgeBand{0.8, 24}, EdgeBand{3, 64}}) {
        constexpr int kCells = 64;
        const auto cells = covering_supports_of_curved(band, kCells);
        ASSERT_EQ(cells.size(), std::size_t{kCells});
        const double reach = kR + band.half_width, most_curved = std::min(0.5, 0.9 / band.half_width);
        double tightest = 1;  // how much of a radius goes unused, where it is used best
        for (int i = 0; i < 4000; ++i) {
            const double magnitude = reach * part(random), d = i % 2 == 0 ? magnitude : -magnitude;
            const Support& cell = cells[static_cast<std::size_t>(magnitude / reach * kCells)];
            EXPECT_EQ(cell.shift, 0);
            const Edge edge = {d, band, INFINITY, most_curved * (2 * part(random) - 1)};
            if (edge.curvature * d > 1) continue;  // past the centre of its sphere: D would not be the distance to it
            const double cosine = 2 * part(random) - 1;
            // Along one direction, from well outside inwards.
            double last = 0;
            for (double r = 0.02; r < cell.radius + 2; r += 0.02)
                if (kernel(warped_distance2(r * r, r * cosine, edge)) > 0) last = r;
            ASSERT_LE(last, cell.radius) << "D " << d << " curvature " << edge.curvature << " cosine " << cosine;
            tightest = std::min(tightest, 1 - last / cell.radius);
        }
        EXPECT_LE(tightest, 0.1) << "larger than there is any need for: every splat pays for it";
    }
    EXPECT_THROW(covering_supports_of_curved({}, 0), std::invalid_argument);
}

}  // namespace
}  // namespace edgesplat

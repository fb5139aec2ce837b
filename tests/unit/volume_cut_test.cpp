// Volumes that others cut: places and normals of cuts against the truth.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <numbers>

#include "engine/error.h"
#include "engine/volume/cut.h"
#include "engine/volume/filters.h"
#include "engine/volume/labels.h"

namespace edgesplat {
namespace {

constexpr double kRadius = 9;  ///< of the ball that cuts, mm
const glm::dvec3 kCentre{15.2, 14.7, 15.4};

/// Step from 1 to 0 at distance 0, as a scanner blurs it; deviation: voxels of 1 mm.
double step(double distance, double deviation) {
    return 0.5 * std::erfc(distance / (std::numbers::sqrt2 * deviation));
}

Volume sampled(const VolumeGeometry& geometry, const std::function<double(const glm::dvec3&)>& value) {
    Volume volume;
    volume.geometry = geometry;
    for (int z = 0; z < geometry.dims.z; ++z)
        for (int y = 0; y < geometry.dims.y; ++y)
            for (int x = 0; x < geometry.dims.x; ++x)
                volume.values.push_back(static_cast<float>(value(geometry.to_world({x, y, z}))));
    finish_volume(volume);
    return volume;
}

VolumeGeometry cube(int size, double spacing = 1) {
    VolumeGeometry geometry;
    geometry.dims = glm::ivec3(size);
    geometry.index_to_world_axes = glm::dmat3(spacing);
    return geometry;
}

/// A grid around the ball with this spacing, turned.
VolumeGeometry turned(const glm::dvec3& spacing) {
    const glm::dmat4 turn = glm::rotate(glm::dmat4(1), 0.6, glm::normalize(glm::dvec3(1, 2, -1)));
    VolumeGeometry geometry;
    geometry.dims = glm::ivec3(26.0 / spacing);
    for (int axis = 0; axis < 3; ++axis)
        geometry.index_to_world_axes[axis] = glm::dvec3(turn[axis]) * spacing[axis];
    geometry.origin = kCentre - geometry.index_to_world_axes * (0.5 * glm::dvec3(geometry.dims - 1));
    return geometry;
}

double from_ball(const glm::dvec3& p) {
    return glm::distance(p, kCentre) - kRadius;
}

Cutter ball(const VolumeGeometry& geometry) {
    const double width = 0.7 * geometry.mean_spacing();
    return {std::make_shared<const Volume>(
                sampled(geometry, [&](const glm::dvec3& p) { return step(from_ball(p), width); })),
            0.5};
}

/// Value and slope (world) of the spline through the samples.
glm::dvec4 spline(const Volume& volume, const std::vector<float>& coefficients, const glm::dvec3& world) {
    const glm::dvec3 place = volume.geometry.to_index(world);
    const SplineTaps x = spline_taps(place.x, volume.geometry.dims.x), y = spline_taps(place.y, volume.geometry.dims.y),
                     z = spline_taps(place.z, volume.geometry.dims.z);
    glm::dvec4 sum(0);
    for (std::size_t i = 0; i < 64; ++i) {
        const std::size_t a = i % 4, b = i / 4 % 4, c = i / 16;
        const double coefficient = coefficients[volume.index_of(x.places[a], y.places[b], z.places[c])];
        sum += coefficient *
               glm::dvec4(x.slopes[a] * y.weights[b] * z.weights[c], x.weights[a] * y.slopes[b] * z.weights[c],
                          x.weights[a] * y.weights[b] * z.slopes[c], x.weights[a] * y.weights[b] * z.weights[c]);
    }
    return {glm::transpose(glm::inverse(volume.geometry.index_to_world_axes)) * glm::dvec3(sum), sum.w};
}

/// Root mean squares over the ball's surface.
struct Errors {
    double distance = 0;  ///< mm
    double normal = 0;    ///< degrees
};

/// `iso`: of the volume that was cut, everywhere in matter around the ball.
Errors errors_of(const Volume& volume, double iso) {
    const std::vector<float> coefficients = bspline_coefficients(volume.values, volume.geometry.dims);
    Errors sums;
    constexpr int kDirections = 2000;
    for (int i = 0; i < kDirections; ++i) {
        const double z = (2 * i + 1.0) / kDirections - 1, angle = std::numbers::pi * (3 - std::sqrt(5)) * i;
        const glm::dvec3 out(std::sqrt(1 - z * z) * std::cos(angle), std::sqrt(1 - z * z) * std::sin(angle), z);
        double low = -1.5, high = 1.5;
        const auto at = [&](double way) { return spline(volume, coefficients, kCentre + (kRadius + way) * out); };
        EXPECT_LT(at(low).w, iso);
        EXPECT_GT(at(high).w, iso);
        for (int halving = 0; halving < 30; ++halving)
            (at(0.5 * (low + high)).w < iso ? low : high) = 0.5 * (low + high);
        sums.distance += low * low / kDirections;
        const double away = std::acos(std::min(glm::dot(glm::normalize(glm::dvec3(at(low))), out), 1.0));
        sums.normal += away * away / kDirections;
    }
    return {std::sqrt(sums.distance), glm::degrees(std::sqrt(sums.normal))};
}

/// The cut is as true as the cutter's own contour; details of a finer grid are smoothed.
TEST(Cuts, HaveTheSurfaceOfWhatCuts) {
    struct Case {
        const char* name;
        VolumeGeometry cutter;
        double farther;  ///< mm
    };
    // Matter of one value, and of values that differ by a factor of three.
    const Volume even = sampled(cube(31), [](const glm::dvec3&) { return 1000; });
    const Volume uneven =
        sampled(cube(31), [](const glm::dvec3& p) { return 1000 + 500 * std::sin(p.x / 3 + p.y / 4); });
    for (const Case& one :
         {Case{"its own grid", cube(31), 0.005}, Case{"turned, unequal", turned({0.9, 1.3, 1.1}), 0.005},
          Case{"twice as fine", turned(glm::dvec3(0.5)), 0.022},
          Case{"four times as fine", turned(glm::dvec3(0.25)), 0.022},
          Case{"three times as coarse", turned(glm::dvec3(3)), 0.005}}) {
        const Cutter cutter = ball(one.cutter);
        Volume hole = *cutter.volume;
        for (float& value : hole.values)
            value = 1 - value;
        const Errors own = errors_of(hole, 0.5);
        for (const Volume* volume : {&even, &uneven}) {
            const Errors errors = errors_of(without_solids(*volume, 100, {&cutter, 1}), 100);
            EXPECT_LT(errors.distance, own.distance + one.farther) << one.name;
            EXPECT_LT(errors.normal, own.normal + (volume == &even ? 0.1 : 0.7)) << one.name;
        }
    }
    const Volume mask = sampled(cube(31), [](const glm::dvec3& p) { return from_ball(p) < 0 ? 7 : 0; });
    const Cutter labels{std::make_shared<const Volume>(drawn_labels(mask)), 0.5};
    const Errors errors = errors_of(without_solids(even, 100, {&labels, 1}), 100);
    EXPECT_LT(errors.distance, 0.1);
    EXPECT_LT(errors.normal, 3.5);
}

TEST(Cuts, LeaveTheRestAsItIs) {
    Volume volume =
        sampled(cube(31), [](const glm::dvec3& p) { return 300 * std::sin(p.x / 3) * std::cos(p.y / 5 + p.z / 4); });
    volume.values[volume.index_of(15, 15, 15)] = std::numeric_limits<float>::quiet_NaN();
    volume.values[volume.index_of(2, 2, 2)] = std::numeric_limits<float>::quiet_NaN();
    finish_volume(volume);
    const Cutter cutter = ball(turned({0.9, 1.3, 1.1}));
    const Volume cut = without_solids(volume, 20, {&cutter, 1});
    EXPECT_NE(cut.checksum, volume.checksum);
    EXPECT_EQ(cut.non_finite_count, 2U);
    EXPECT_FALSE(cut.has_data(volume.index_of(15, 15, 15)) || cut.has_data(volume.index_of(2, 2, 2)));
    for (int z = 0; z < 31; ++z)
        for (int y = 0; y < 31; ++y)
            for (int x = 0; x < 31; ++x) {
                const double outside = from_ball({x, y, z});
                const float before = volume.at(x, y, z), after = cut.at(x, y, z);
                const bool stays = after == before, removed = after < 20 || !cut.has_data({x, y, z});
                EXPECT_TRUE(stays || outside < kCutReach + 0.1) << x << ' ' << y << ' ' << z;
                EXPECT_TRUE(removed || outside > -0.1) << x << ' ' << y << ' ' << z;
                EXPECT_LE(after, before);
            }
    // A solid elsewhere, and one without matter, change nothing; nor does the order of two.
    auto moved = std::make_shared<Volume>(*cutter.volume);
    moved->geometry.origin.x += 100;
    const std::vector<Cutter> nothing{{moved, 0.5}, {cutter.volume, 2}};
    EXPECT_EQ(without_solids(volume, 20, nothing).checksum, volume.checksum);
    const Cutter second{std::make_shared<const Volume>(sampled(cube(12), [](const glm::dvec3&) { return 1; })), 0.5};
    const std::vector<Cutter> one_way{cutter, second}, other_way{second, cutter};
    const Volume both = without_solids(volume, 20, one_way);
    EXPECT_EQ(both.checksum, without_solids(volume, 20, other_way).checksum);
    EXPECT_LT(both.at(3, 3, 3), 20);
}

/// A cutter whose solid reaches its grid's border cuts up to there.
TEST(Cuts, EndAtTheBorderOfWhatCuts) {
    const Volume volume = sampled(cube(20), [](const glm::dvec3&) { return 1; });
    VolumeGeometry geometry = cube(20);
    geometry.dims.x = 8;
    const Cutter half{std::make_shared<const Volume>(sampled(geometry, [](const glm::dvec3&) { return 1; })), 0.5};
    const Volume cut = without_solids(volume, 0.25, {&half, 1});
    const std::vector<float> coefficients = bspline_coefficients(cut.values, cut.geometry.dims);
    EXPECT_NEAR(spline(cut, coefficients, {7.5, 9, 9}).w, 0.25, 1e-3);
    EXPECT_LT(cut.at(7, 9, 9), 0.25);
    EXPECT_EQ(cut.at(10, 9, 9), 1);
    // Samples of NaN are no solid.
    Volume gap = *half.volume;
    for (int i = 0; i < 8; ++i)
        gap.values[gap.index_of(i, 9, 9)] = std::numeric_limits<float>::quiet_NaN();
    gap.values[0] = -1;
    finish_volume(gap);
    const Cutter with_gap{std::make_shared<const Volume>(gap), 0.5};
    EXPECT_GT(without_solids(volume, 0.25, {&with_gap, 1}).at(4, 9, 9), 0.25);
}

/// Solids far smaller or larger than a voxel, flat or mirrored: finite, and gone or whole.
TEST(Cuts, StayFiniteOnExtremeGrids) {
    const Volume volume = sampled(cube(24), [](const glm::dvec3&) { return 1; });
    for (const double scale : {1e-8, 1e-3, -0.5, 40.0, 1e7}) {
        Cutter cutter = ball(cube(31));
        Volume moved = *cutter.volume;
        moved.geometry.index_to_world_axes *= scale;
        moved.geometry.origin = glm::dvec3(12) - scale * kCentre;
        cutter.volume = std::make_shared<const Volume>(moved);
        const Volume cut = without_solids(volume, 0.25, {&cutter, 1});
        EXPECT_EQ(cut.non_finite_count, 0U) << scale;
        if (std::abs(scale) < 0.1) {
            EXPECT_EQ(cut.at(6, 6, 6), 1) << scale;
        } else if (scale > 2) {
            EXPECT_LT(cut.max_value, 0.25) << scale;
        } else {
            EXPECT_LT(cut.at(12, 12, 12), 0.25) << scale;
            EXPECT_EQ(cut.at(4, 12, 12), 1) << scale;
        }
    }
    const Cutter itself{std::make_shared<const Volume>(volume), 0.25};
    EXPECT_LE(without_solids(volume, 0.25, {&itself, 1}).max_value, 0.25F);
}

TEST(Cuts, RemoveLabels) {
    const Volume mask = sampled(cube(31), [](const glm::dvec3& p) { return p.x < 15 ? 1 : 2; });
    Volume labels = drawn_labels(mask, labels_of(mask), {true, true});
    const Cutter cutter = ball(cube(31));
    const Volume cut = without_solids(labels, 0.5, {&cutter, 1});
    ASSERT_TRUE(cut.is_label_mask());
    for (int x = 2; x < 29; ++x) {
        const std::size_t at = cut.index_of(x, 15, 15);
        EXPECT_EQ(cut.shown_labels->at[at] == 0, from_ball({x, 15, 15}) < 0) << x;
        EXPECT_EQ(cut.values[at] < 0.5F, from_ball({x, 15, 15}) < 0) << x;
    }
}

}  // namespace
}  // namespace edgesplat

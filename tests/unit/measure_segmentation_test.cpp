// A scan with a segmentation: labels on other grids, and matter of chosen labels alone.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "engine/measure/extents.h"
#include "engine/volume/labels.h"
#include "engine/volume/segmentation.h"
#include "tests/unit/refusal.h"

namespace edgesplat {
namespace {

const glm::dvec3 kMiddle(3.1, -2.2, 5.3);  // mm
constexpr double kRadius = 13;             // mm
constexpr double kIso = 100;

/// Samples of a function of world positions on a grid with any axes, its centre at kMiddle.
template <typename Value>
Volume on_grid(const glm::ivec3& dims, const glm::dmat3& axes, const Value& value) {
    Volume volume;
    volume.name = "made";
    volume.geometry.dims = dims;
    volume.geometry.index_to_world_axes = axes;
    volume.geometry.origin = kMiddle - axes * (glm::dvec3(dims - 1) / 2.0);
    for (int z = 0; z < dims.z; ++z)
        for (int y = 0; y < dims.y; ++y)
            for (int x = 0; x < dims.x; ++x)
                volume.values.push_back(static_cast<float>(value(volume.geometry.to_world({x, y, z}))));
    finish_volume(volume);
    return volume;
}

/// A ball whose density falls off over its rim.
double density(const glm::dvec3& p) {
    return 2 * kIso / (1 + std::exp((glm::length(p - kMiddle) - kRadius) / 0.5));
}

/// Halves of the ball, 4 and 9, and a pole of 7.
double label(const glm::dvec3& p) {
    const glm::dvec3 from = p - kMiddle;
    if (glm::length(from) > kRadius) return 0;
    return from.z > 10 ? 7 : from.x < 0 ? 4 : 9;
}

Volume scan() {
    return on_grid({40, 36, 38}, glm::dmat3(1, 0.1, 0, -0.1, 1, 0, 0, 0, 0.9), density);
}

double ball_of_scan(const Volume& volume) {
    const double iso[] = {kIso};
    return measure::measure_extents(volume, iso).volumes[1].value;
}

TEST(Segmentation, MayHaveAnyGrid) {
    const glm::dmat3 flipped(-0.7, 0, 0, 0, 0, 0.8, 0, 0.6, 0);
    Volume with = scan();
    const Volume bare = with;
    add_segmentation(with, on_grid({48, 46, 44}, flipped, label));
    EXPECT_EQ(with.values, bare.values);
    EXPECT_TRUE(with.has_segmentation());
    EXPECT_FALSE(with.is_label_mask());
    EXPECT_NE(with.checksum, bare.checksum);
    ASSERT_EQ(with.labels->labels.size(), 3U);
    std::size_t at = 0, wrong = 0;
    const glm::ivec3 dims = with.geometry.dims;
    for (int z = 0; z < dims.z; ++z)
        for (int y = 0; y < dims.y; ++y)
            for (int x = 0; x < dims.x; ++x, ++at) {
                const std::uint32_t number = with.shown_labels->at[at];
                const double found = number == 0 ? 0 : static_cast<double>(with.labels->labels[number - 1].value);
                const glm::dvec3 p = with.geometry.to_world({x, y, z}), from = p - kMiddle;
                // Half a voxel of the segmentation beside an end of a label, either may be nearest.
                const bool end = std::abs(glm::length(from) - kRadius) < 0.75 || std::abs(from.x) < 0.75 ||
                                 std::abs(from.z - 10) < 0.75;
                wrong += !end && found != label(p) ? 1U : 0U;
            }
    EXPECT_EQ(wrong, 0U);
    EXPECT_EQ(with.notes.size(), bare.notes.size() + 1);
}

TEST(Segmentation, IsMeasuredWithTheScansValues) {
    Volume with = scan();
    add_segmentation(with, on_grid({40, 36, 38}, scan().geometry.index_to_world_axes, label));
    EXPECT_TRUE(with.notes.empty()) << "one grid";
    double sum = 0, squares = 0, count = 0;
    for (std::size_t i = 0; i < with.values.size(); ++i)
        if (with.shown_labels->at[i] == 3) {
            const auto value = static_cast<double>(with.values[i]);
            sum += value;
            squares += value * value;
            ++count;
        }
    const auto extents = measure::measure_labels(with);
    ASSERT_EQ(extents.size(), 3U);
    EXPECT_EQ(extents[2].number, "9");
    EXPECT_EQ(extents[2].voxels, static_cast<std::size_t>(count));
    ASSERT_TRUE(extents[2].values);
    EXPECT_NEAR(extents[2].values->x, sum / count, 1e-9 * kIso);
    EXPECT_NEAR(extents[2].values->y, std::sqrt(squares / count - std::pow(sum / count, 2)), 1e-6 * kIso);
}

TEST(Segmentation, LeavesTheScansSurface) {
    Volume with = scan();
    add_segmentation(with, on_grid({40, 36, 38}, scan().geometry.index_to_world_axes, label));
    const double whole = ball_of_scan(with);
    ASSERT_NEAR(whole, 4.0 / 3 * std::numbers::pi * std::pow(kRadius, 3), 0.01 * whole);
    // All labels: matter ends where that of the scan does, within a twentieth of a voxel.
    const double rim = 4 * std::numbers::pi * kRadius * kRadius * 0.05;
    EXPECT_NEAR(ball_of_scan(with_labels_shown(with, {true, true, true}, false, kIso)), whole, rim);
    EXPECT_NEAR(ball_of_scan(with_labels_shown(with, {true, true, true}, true, kIso)), whole, 1e-9 * whole);
}

TEST(Segmentation, CutsMatterBetweenLabels) {
    Volume with = scan();
    add_segmentation(with, on_grid({40, 36, 38}, scan().geometry.index_to_world_axes, label));
    const double whole = ball_of_scan(with), disc = std::numbers::pi * kRadius * kRadius;
    double parts = 0;
    for (int part = 0; part < 3; ++part) {
        std::vector<bool> shown(3, false);
        shown[static_cast<std::size_t>(part)] = true;
        const Volume one = with_labels_shown(with, shown, false, kIso);
        EXPECT_EQ(one.shown_labels->largest, std::vector<std::uint32_t>{static_cast<std::uint32_t>(part) + 1});
        parts += ball_of_scan(one);
        // Hiding the label leaves the rest, with all matter of no label.
        shown.flip();
        EXPECT_NEAR(ball_of_scan(with_labels_shown(with, shown, true, kIso)) + ball_of_scan(one), whole, 0.15 * disc);
    }
    EXPECT_NEAR(parts, whole, 0.3 * disc);
}

TEST(Segmentation, RefusesWhatDoesNotFit) {
    Volume with = scan();
    const Volume grey = on_grid({20, 20, 20}, glm::dmat3(1), density);
    EXPECT_NE(refusal([&] { add_segmentation(with, grey); }).find("expected a segmentation"), std::string::npos);
    Volume elsewhere = on_grid({40, 36, 38}, glm::dmat3(1), label);
    elsewhere.geometry.origin += glm::dvec3(500, 0, 0);
    EXPECT_NE(refusal([&] { add_segmentation(with, elsewhere); }).find("none of its labels lies in made"),
              std::string::npos);
    add_segmentation(with, on_grid({40, 36, 38}, glm::dmat3(1), label));
    EXPECT_NE(refusal([&] {
                  with_labels_shown(with, {true, false, false}, false, 2.5 * kIso);
              }).find("no value above"),
              std::string::npos);
}

}  // namespace
}  // namespace edgesplat

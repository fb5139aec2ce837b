// Editing transfer functions.
#include "engine/viewer/transfer_edit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/scene/transfer_function.h"
#include "tests/unit/refusal.h"
#include "tests/unit/viewer_random.h"
#include "tests/unit/viewer_volumes.h"

namespace edgesplat::viewer {
namespace {

using namespace viewer_test;

const TransferPoints kPoints{{-2, {1, 0, 0}, 0}, {1, {0, 1, 0}, 3}, {1.5, {0, 0, 1}, 1}};
constexpr double kGap = 0.01;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(TransferEdit, AddingPointKeepsFunction) {
    for (const double value : {-5.0, -1.9, 0.25, 1.2, 8.0}) {
        TransferPoints points = kPoints;
        const auto place = add_transfer_point(points, value, kGap);
        ASSERT_TRUE(place) << value;
        EXPECT_EQ(points[*place], transfer_at(kPoints, value));
        for (double at = -6; at < 9; at += 0.03125) {
            EXPECT_NEAR(transfer_at(points, at).extinction, transfer_at(kPoints, at).extinction, 1e-12);
            EXPECT_LT(glm::length(transfer_at(points, at).color - transfer_at(kPoints, at).color), 1e-12);
        }
    }
}

TEST(TransferEdit, RefusesPointsOnOthersOrInEmptyFunction) {
    TransferPoints points = kPoints;
    EXPECT_FALSE(add_transfer_point(points, 1, kGap));
    EXPECT_FALSE(add_transfer_point(points, 0.995, kGap));
    EXPECT_FALSE(add_transfer_point(points, 1.009, kGap));
    EXPECT_FALSE(add_transfer_point(points, kNan, kGap));
    EXPECT_FALSE(add_transfer_point(points, -std::numeric_limits<double>::infinity(), kGap));
    EXPECT_EQ(points, kPoints);
    points.clear();
    EXPECT_FALSE(add_transfer_point(points, 0, kGap));
}

TEST(TransferEdit, LimitsNumberOfPoints) {
    TransferPoints points = kPoints;
    while (points.size() < kMaxTransferPoints)
        ASSERT_TRUE(add_transfer_point(points, points.back().value + 1, kGap));
    EXPECT_FALSE(add_transfer_point(points, 1e4, kGap));
    EXPECT_EQ(points.size(), kMaxTransferPoints);
}

TEST(TransferEdit, MovedPointStopsBeforeNeighbours) {
    TransferPoints points = kPoints;
    move_transfer_point(points, 1, 0.5, 7, kGap);
    EXPECT_EQ(points[1], (TransferPoint{0.5, {0, 1, 0}, 7}));
    move_transfer_point(points, 1, 90, 2, kGap);
    EXPECT_EQ(points[1].value, 1.5 - kGap);
    move_transfer_point(points, 1, -90, -2, kGap);
    EXPECT_EQ(points[1].value, -2 + kGap);
    EXPECT_EQ(points[1].extinction, 0);
    move_transfer_point(points, 0, -1e6, 1, kGap);
    EXPECT_EQ(points[0].value, -1e6);
    move_transfer_point(points, 2, 1e6, 1, kGap);
    EXPECT_EQ(points[2].value, 1e6);
    const TransferPoints before = points;
    move_transfer_point(points, 1, kNan, kNan, kGap);
    EXPECT_EQ(points, before);
}

TEST(TransferEdit, CrowdedPointChangesOnlyExtinction) {
    TransferPoints points{{0, glm::dvec3(1), 1}, {0.005, glm::dvec3(1), 1}, {0.01, glm::dvec3(1), 1}};
    move_transfer_point(points, 1, 0.009, 4, kGap);
    EXPECT_EQ(points[1].value, 0.005);
    EXPECT_EQ(points[1].extinction, 4);
}

TEST(TransferEdit, KeepsLastPoint) {
    TransferPoints points = kPoints;
    EXPECT_FALSE(remove_transfer_point(points, 3));
    EXPECT_TRUE(remove_transfer_point(points, 1));
    EXPECT_EQ(points, (TransferPoints{kPoints[0], kPoints[2]}));
    EXPECT_TRUE(remove_transfer_point(points, 1));
    EXPECT_FALSE(remove_transfer_point(points, 0));
    EXPECT_EQ(points, (TransferPoints{kPoints[0]}));
}

TEST(TransferEdit, RandomEditsKeepFunctionValid) {
    Random random(3);
    const auto uniform = [&] { return random(0, 1); };
    TransferPoints points = kPoints;
    Scene scene;
    scene.materials.resize(1);
    for (int i = 0; i < 3000; ++i) {
        const auto place = static_cast<std::size_t>(uniform() * static_cast<double>(points.size()));
        const double value = 10 * uniform() - 5, what = uniform();
        if (what < 0.3)
            add_transfer_point(points, value, kGap);
        else if (what < 0.4)
            remove_transfer_point(points, place);
        else
            move_transfer_point(points, place, value, 20 * uniform() - 5, kGap);
        scene.transfer = points;
        ASSERT_NO_THROW(validate(scene)) << i;
    }
}

TEST(TransferEdit, ConvertsMaterialsToEqualFunction) {
    Scene scene;
    scene.iso_values = {0.2, 0.6, 0.601};
    scene.materials = {{{0, 0, 0}, 0}, {{1, 0, 0}, 0.5}, {{0, 1, 0}, 4}, {{0, 0, 1}, 9}};
    const double width = 0.01;
    const TransferPoints points = transfer_of_materials(scene, 0, 1, width);
    ASSERT_EQ(points.size(), 8U);
    EXPECT_EQ(points.front().value, 0);
    EXPECT_EQ(points.back().value, 1);
    for (double value = -0.1; value < 1.1; value += 1.0 / 4096) {
        std::size_t m = 0;
        double above = 1;
        for (const double iso : scene.iso_values) {
            if (value >= iso) ++m;
            if (iso > value) above = std::min(above, iso - value);
        }
        if (above <= width) continue;  // on a step
        EXPECT_EQ(transfer_at(points, value).extinction, scene.materials[m].extinction) << value;
        // A transparent interval has the colour of the next interval.
        EXPECT_EQ(transfer_at(points, value).color, scene.materials[std::max<std::size_t>(m, 1)].color) << value;
    }
    scene.transfer = points;
    EXPECT_NO_THROW(validate(scene));
    // Ends that coincide with steps are not duplicated.
    EXPECT_EQ(transfer_of_materials(scene, 0.19, 0.601, width).size(), 6U);
}

TEST(TransferEdit, SwitchesBetweenMaterialsAndFunctions) {
    const auto volume = sampled(hollow_ball(16, 5));
    SceneDocument d;
    d.iso_values = {0.5};
    d.materials = {{.name = "wall"}};
    const SceneDocument before = d;
    use_transfer(d, kPoints);
    EXPECT_EQ(d.transfer, kPoints);
    EXPECT_EQ(d.iso_values, before.iso_values);
    use_materials(d, *volume);
    EXPECT_TRUE(d.transfer.empty());
    EXPECT_EQ(d.iso_values, before.iso_values);
    EXPECT_EQ(d.materials.at(0).name, "wall");
    EXPECT_EQ(resolve_scene(d, *volume).materials, resolve_scene(before, *volume).materials);
    // A function without edges leaves no iso-value: one is chosen.
    use_transfer(d, kPoints);
    d.iso_values.clear();
    d.materials.clear();
    use_materials(d, *volume);
    EXPECT_EQ(d.iso_values.size(), 1U);
    EXPECT_EQ(d.materials.size(), 1U);
}

TEST(TransferEdit, PresetAppliesWhollyOrNotAtAll) {
    const auto volume = sampled(hollow_ball(16, 5));
    SceneDocument d;
    d.iso_values = {0.3, 0.4};
    d.materials.resize(2);
    ScenePreset preset{"some", "built in", {}};
    preset.content.transfer = kPoints;
    preset.content.iso_values = {0.5};
    use_transfer_preset(d, *volume, preset);
    EXPECT_EQ(d.transfer, kPoints);
    EXPECT_EQ(d.iso_values, std::vector{0.5});
    EXPECT_EQ(d.materials.size(), 1U);
    const SceneDocument before = d;
    preset.content.iso_values = {-400};
    EXPECT_NE(refusal([&] { use_transfer_preset(d, *volume, preset); }).find("-400"), std::string::npos);
    EXPECT_EQ(d, before);
}

TEST(TransferEdit, ExtinctionScaleIsInvertible) {
    const ExtinctionScale scale = ExtinctionScale::of(sampled(hollow_ball(16, 5))->geometry);
    EXPECT_EQ(scale.share(0), 0);
    EXPECT_EQ(scale.extinction(0), 0);
    EXPECT_NEAR(scale.share(scale.most), 1, 1e-15);
    EXPECT_NEAR(scale.extinction(1), scale.most, 1e-9 * scale.most);
    EXPECT_EQ(scale.share(1e9), 1);
    for (double share = 0; share <= 1; share += 0.01)
        EXPECT_NEAR(scale.share(scale.extinction(share)), share, 1e-12);
    for (double e = 1e-4; e < 1e3; e *= 1.7)
        EXPECT_NEAR(scale.extinction(scale.share(e)), e, 1e-10 * e);
}

}  // namespace
}  // namespace edgesplat::viewer

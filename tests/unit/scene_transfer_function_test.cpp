#include <gtest/gtest.h>

#include "engine/scene/transfer_function.h"

namespace edgesplat {
namespace {

const std::vector<TransferPoint> kPoints{{-2, {1, 0, 0}, 0}, {1, {0, 1, 0}, 3}, {1.5, {0, 0, 1}, 1}};

TEST(TransferFunction, IsLinearBetweenItsPointsAndConstantBeyond) {
    EXPECT_EQ(transfer_at(kPoints, -100), (TransferPoint{-100, {1, 0, 0}, 0}));
    EXPECT_EQ(transfer_at(kPoints, -2), kPoints[0]);
    EXPECT_EQ(transfer_at(kPoints, 1), kPoints[1]);
    EXPECT_EQ(transfer_at(kPoints, 1.5), kPoints[2]);
    EXPECT_EQ(transfer_at(kPoints, 9), (TransferPoint{9, {0, 0, 1}, 1}));
    EXPECT_EQ(transfer_at(kPoints, -0.5), (TransferPoint{-0.5, {0.5, 0.5, 0}, 1.5}));
    EXPECT_EQ(transfer_at(kPoints, 1.25), (TransferPoint{1.25, {0, 0.5, 0.5}, 2}));
    EXPECT_EQ(transfer_at({kPoints.data() + 1, 1}, -7), (TransferPoint{-7, {0, 1, 0}, 3}));
}

TEST(TransferFunction, BoundsExtinctionsOfEveryInterval) {
    Scene scene;
    scene.transfer = kPoints;
    scene.materials.resize(1);
    EXPECT_EQ(extinctions_of(scene, 0).least, 0);
    EXPECT_EQ(extinctions_of(scene, 0).most, 3);
    scene.iso_values = {-0.5, 1.25};
    scene.materials.resize(3);
    EXPECT_EQ(extinctions_of(scene, 0).least, 0);
    EXPECT_EQ(extinctions_of(scene, 0).most, 1.5);
    EXPECT_EQ(extinctions_of(scene, 1).least, 1.5);
    EXPECT_EQ(extinctions_of(scene, 1).most, 3);
    EXPECT_EQ(extinctions_of(scene, 2).least, 1);
    EXPECT_EQ(extinctions_of(scene, 2).most, 2);
    scene.transfer.clear();
    scene.materials[1].extinction = 7;
    EXPECT_EQ(extinctions_of(scene, 1).least, 7);
    EXPECT_EQ(extinctions_of(scene, 1).most, 7);
}

TEST(TransferFunction, IsScaledWithTheSamples) {
    Volume volume;
    volume.min_value = -10;
    volume.max_value = 30;
    Scene scene;
    EXPECT_TRUE(scaled_transfer(scene, volume).empty());
    scene.transfer = kPoints;
    const auto scaled = scaled_transfer(scene, volume);
    ASSERT_EQ(scaled.size(), 3U);
    EXPECT_NEAR(scaled[0].value, 0.2, 1e-7);
    EXPECT_EQ(scaled[1].color, kPoints[1].color);
    volume.max_value = -10;  // constant
    const auto constant = scaled_transfer(scene, volume);
    ASSERT_EQ(constant.size(), 1U);
    EXPECT_EQ(constant[0].extinction, 0);
    volume.min_value = volume.max_value = 1;
    EXPECT_EQ(scaled_transfer(scene, volume)[0].extinction, 3);
}

}  // namespace
}  // namespace edgesplat

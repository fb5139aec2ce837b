// Recognition of segmentations (label volumes).
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "engine/error.h"
#include "engine/volume/labels.h"

namespace {

using edgesplat::labels_of;

edgesplat::Volume sampled(const std::function<double(const glm::dvec3&)>& value) {
    edgesplat::Volume volume;
    volume.geometry.dims = {40, 30, 20};
    for (int z = 0; z < 20; ++z)
        for (int y = 0; y < 30; ++y)
            for (int x = 0; x < 40; ++x)
                volume.values.push_back(static_cast<float>(value({x, y, z})));
    finish_volume(volume);
    return volume;
}

/// Two organs, one embedded in the side of the other, and a thin one.
double organ(const glm::dvec3& p) {
    if (glm::distance(p, {15, 15, 10}) < 5) return 7;
    if (glm::distance(p, {20, 15, 10}) < 9) return 3;
    return std::abs(p.x - 35) < 1 ? 250 : 0;
}

TEST(Labels, AreFewWholeNumbersWithoutPartialVolume) {
    EXPECT_EQ(labels_of(sampled(organ)), (std::vector<float>{0, 3, 7, 250}));
    EXPECT_EQ(labels_of(sampled([](const glm::dvec3& p) { return organ(p) == 3 ? 1 : 0; })), (std::vector<float>{0, 1}))
        << "a mask";
}

TEST(Labels, RejectsMeasuredValues) {
    const auto blurred = [](const glm::dvec3& p) {
        double sum = 0;
        for (int i = 0; i < 27; ++i)
            sum += organ(p + glm::dvec3(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1));
        return sum / 27;
    };
    EXPECT_TRUE(labels_of(sampled(blurred)).empty()) << "fractions";
    EXPECT_TRUE(labels_of(sampled([&](const glm::dvec3& p) { return std::round(blurred(p)); })).empty())
        << "partial volume, in whole numbers";
    EXPECT_TRUE(labels_of(sampled([](const glm::dvec3&) { return 4; })).empty()) << "constant";
    EXPECT_TRUE(labels_of(sampled([](const glm::dvec3& p) { return p.x + 40 * p.y; })).empty()) << "many values";
}

TEST(Labels, AreDrawnAsNumbersAboveOne) {
    const edgesplat::Volume drawn = edgesplat::drawn_labels(sampled(organ));
    EXPECT_EQ(drawn.at(0, 0, 0), 0) << "the label at the border is the background";
    EXPECT_FLOAT_EQ(drawn.at(22, 15, 10), 1 + 3.0F / 1024);
    EXPECT_FLOAT_EQ(drawn.at(15, 15, 10), 1 + 7.0F / 1024);
    EXPECT_FLOAT_EQ(drawn.at(35, 1, 10), 1 + 250.0F / 1024);
    // With negative labels, ranks replace all labels; the background is 4 here.
    const edgesplat::Volume ranked =
        edgesplat::drawn_labels(sampled([](const glm::dvec3& p) { return organ(p) == 0 ? 4 : -10 * organ(p); }));
    EXPECT_EQ(ranked.at(0, 0, 0), 0);
    EXPECT_FLOAT_EQ(ranked.at(35, 1, 10), 1 + 1.0F / 1024);
    EXPECT_FLOAT_EQ(ranked.at(22, 15, 10), 1 + 3.0F / 1024);
    EXPECT_THROW(edgesplat::drawn_labels(sampled([](const glm::dvec3& p) { return p.x / 3; })), edgesplat::Error);
}

}  // namespace

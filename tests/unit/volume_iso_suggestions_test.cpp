// Suggested iso-values: strong, smooth surfaces that are visible from outside, and no padding.
#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "engine/volume/filters.h"

namespace edgesplat {
namespace {

using Field = std::function<double(const glm::dvec3&)>;

/// The field at the voxels of a cube, with Gaussian noise of standard deviation `noise`.
Volume sampled(const Field& field, double noise = 0) {
    constexpr int kSide = 40;
    Volume volume;
    volume.geometry.dims = glm::ivec3(kSide);
    volume.name = "sampled";
    std::mt19937 random(7);
    std::normal_distribution<double> gauss(0, 1);
    for (int z = 0; z < kSide; ++z)
        for (int y = 0; y < kSide; ++y)
            for (int x = 0; x < kSide; ++x)
                volume.values.push_back(static_cast<float>(field({x, y, z}) + noise * gauss(random)));
    finish_volume(volume);
    return volume;
}

double from_middle(const glm::dvec3& p) {
    return glm::length(p - 19.5);
}

/// 1 inside a ball, 0 outside; the edge is about two voxels wide.
double ball(const glm::dvec3& p, double radius) {
    return 1 / (1 + std::exp(2 * (from_middle(p) - radius)));
}

double first(const Volume& volume) {
    return suggest_iso_values(volume).at(0).value;
}

TEST(IsoSuggestions, PrefersOuterToHiddenSurface) {
    // The core's step is 150, the outer step 100, but rays from outside meet the outer surface first.
    const Volume volume = sampled([](const glm::dvec3& p) { return 100 * ball(p, 15) + 150 * ball(p, 4); });
    const double value = first(volume);
    EXPECT_GT(value, 20);
    EXPECT_LT(value, 90);
}

TEST(IsoSuggestions, IgnoresNoise) {
    const Volume volume = sampled([](const glm::dvec3& p) { return 400 * ball(p, 12); }, 30);
    const double value = first(volume);
    EXPECT_GT(value, 120) << "above the noise of the background";
    EXPECT_LT(value, 300) << "below the noise of the ball";
}

TEST(IsoSuggestions, IgnoresPadding) {
    // A body in a scanner's cylinder of noisy air; the corners were not measured (padding).
    const Volume noisy = sampled([](const glm::dvec3& p) { return -1000 + 1040 * ball(p, 11); }, 8);
    Volume padded = noisy;
    for (int z = 0; z < 40; ++z)
        for (int y = 0; y < 40; ++y)
            for (int x = 0; x < 40; ++x)
                if (glm::length(glm::dvec2(x, y) - 19.5) > 19)
                    padded.values[static_cast<std::size_t>((z * 40 + y) * 40 + x)] = -3024;
    finish_volume(padded);
    EXPECT_NEAR(first(noisy), -480, 250);
    EXPECT_NEAR(first(padded), -480, 250);
    for (const IsoSuggestion& suggestion : suggest_iso_values(padded))
        EXPECT_GT(suggestion.value, -1050);
}

TEST(IsoSuggestions, KeepsSurfaceOnZeroBackground) {
    // An extracted brain with values from 50 to 150 on a background of 0: the step to 0 is its surface.
    const Volume volume = sampled([](const glm::dvec3& p) {
        const double share = ball(p, 15);
        return share < 0.3 ? 0 : 50 + 100 * share + 3 * std::sin(p.x);
    });
    const double value = first(volume);
    EXPECT_GT(value, 10);
    EXPECT_LT(value, 130);
}

TEST(IsoSuggestions, ChoosesMiddleOfEqualCandidates) {
    // No sample lies between 0 and 80: all iso-values there have the same surface.
    const Volume volume = sampled([](const glm::dvec3& p) {
        const double r = from_middle(p);
        return r < 12 ? 80 + (12 - r) : 0;
    });
    EXPECT_NEAR(first(volume), 40, 4);
}

}  // namespace
}  // namespace edgesplat

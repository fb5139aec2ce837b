// Default surfaces: strong, smooth, seen from outside, and no padding.
#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "engine/volume/filters.h"

namespace edgesplat {
namespace {

using Field = std::function<double(const glm::dvec3&)>;

/// The field at the voxels of a cube, with noise of that standard deviation.
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

/// 1 inside of a ball, 0 outside, over some two voxels.
double ball(const glm::dvec3& p, double radius) {
    return 1 / (1 + std::exp(2 * (from_middle(p) - radius)));
}

double first(const Volume& volume) {
    return suggest_iso_values(volume).at(0).value;
}

TEST(IsoSuggestions, AHiddenSurfaceYieldsToTheOneAroundIt) {
    // The core's surface is four times as strong, and hardly smaller; no ray from outside is the first to meet it
    // alone.
    const Volume volume = sampled([](const glm::dvec3& p) { return 100 * ball(p, 15) + 150 * ball(p, 4); });
    const double value = first(volume);
    EXPECT_GT(value, 20);
    EXPECT_LT(value, 90);
}

TEST(IsoSuggestions, NoiseIsNoSurface) {
    const Volume volume = sampled([](const glm::dvec3& p) { return 400 * ball(p, 12); }, 30);
    const double value = first(volume);
    EXPECT_GT(value, 120) << "not in the noise of what is around";
    EXPECT_LT(value, 300) << "nor in that of the ball";
}

TEST(IsoSuggestions, PaddingIsNoSurface) {
    // A scanner's cylinder of noisy air with a body in it, and corners that were never measured.
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

TEST(IsoSuggestions, NothingAroundAThingIsNoPadding) {
    // Values begin at 50 of 150 where a brain is cut out: the step down to 0 is its surface.
    const Volume volume = sampled([](const glm::dvec3& p) {
        const double share = ball(p, 15);
        return share < 0.3 ? 0 : 50 + 100 * share + 3 * std::sin(p.x);
    });
    const double value = first(volume);
    EXPECT_GT(value, 10);
    EXPECT_LT(value, 130);
}

TEST(IsoSuggestions, OfEqualsTheMiddleIsTaken) {
    // No sample lies between 0 and 80: all values there have one surface.
    const Volume volume = sampled([](const glm::dvec3& p) {
        const double r = from_middle(p);
        return r < 12 ? 80 + (12 - r) : 0;
    });
    EXPECT_NEAR(first(volume), 40, 4);
}

}  // namespace
}  // namespace edgesplat

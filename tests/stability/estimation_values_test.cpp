// Pass 1 with difficult values: constant, too small, too large, not a number, too few bits.
#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/stability/hazard.h"

namespace edgesplat::test {
namespace {

constexpr float kNaNSample = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// A ball of values 0..1 in 20^3, iso-value 0.5.
VolumePointer ball() {
    static const auto volume = std::make_shared<const Volume>(sample(sphere_scene({20, 20, 20}, {9.4, 9.7, 9.5}, 5.3)));
    return volume;
}

/// The ball with values v * scale + offset must look like the ball.
void expect_the_balls_picture(double scale, double offset, double psnr) {
    const auto other = changed(ball(), [&](float v, const glm::ivec3&) {
        return static_cast<float>(static_cast<double>(v) * scale + offset);
    });
    const Image want = sound(shot_of(ball()), "as it is").color;
    const Image got = sound(shot_of(other, 0.5 * scale + offset), "scaled").color;
    EXPECT_GE(compare_images(want, got).psnr, psnr);
    const Estimate e = estimate(other, {0.5 * scale + offset}, EdgeEstimator::March);
    EXPECT_EQ(e.lowest, 0);
    EXPECT_EQ(e.highest, 1);
    EXPECT_GT(e.edges(), 500U);
}

void expect_no_edges(const VolumePointer& volume, double iso_value) {
    for (const EdgeEstimator estimator : kEstimators) {
        const Estimate e = estimate(volume, {iso_value}, estimator);
        EXPECT_EQ(e.edges(), 0U) << name_of(estimator);
        EXPECT_LE(e.differing(), 0) << name_of(estimator);
    }
}

TEST(EstimationValues, ConstantBelowTheIsoValueShowsNothing) {
    const auto volume = volume_of({9, 9, 9}, [](const glm::ivec3&) { return 0.25F; });
    expect_no_edges(volume, 0.5);
    EXPECT_EQ(middle_of(sound(shot_of(volume), "constant").color, 3).most, 0);
}

TEST(EstimationValues, ConstantAboveTheIsoValueGivesAFullBlock) {
    const auto volume = volume_of({12, 12, 12}, [](const glm::ivec3&) { return 0.75F; });
    expect_no_edges(volume, 0.5);
    const Middle thick = thickness_along_x(shot_of(volume));
    EXPECT_NEAR(thick.least, 12, 0.02);
    EXPECT_NEAR(thick.most, 12, 0.02);
}

TEST(EstimationValues, ConstantAtTheIsoValueGivesAFullBlock) {
    const auto volume = volume_of({12, 12, 12}, [](const glm::ivec3&) { return 0.5F; });
    expect_no_edges(volume, 0.5);
    const Middle thick = thickness_along_x(shot_of(volume));
    EXPECT_NEAR(thick.least, 12, 0.02);
    EXPECT_NEAR(thick.most, 12, 0.02);
}

TEST(EstimationValues, IsoValueAboveTheDataShowsNothing) {
    expect_no_edges(ball(), 1.5);
    EXPECT_EQ(middle_of(sound(shot_of(ball(), 1.5), "above").color, 3).most, 0);
}

TEST(EstimationValues, IsoValueBelowTheDataGivesAFullBlock) {
    expect_no_edges(ball(), -0.5);
    EXPECT_NEAR(thickness_along_x(shot_of(ball(), -0.5)).mean, 20, 5e-3);
}

TEST(EstimationValues, IsoValueAtTheLargestSampleGivesThatVoxel) {
    // Only the largest sample is at the iso-value or above: one kernel, whichever way it is warped.
    const auto peak = volume_of({15, 15, 15}, [](const glm::ivec3& v) { return v == glm::ivec3(7) ? 1.0F : 0.0F; });
    Shot shot = shot_of(peak, 1);
    expect_as_reference(shot, "a peak", 0.05);
    EXPECT_GT(sound(shot, "a peak").color.at(16, 16, 3), 0.3F);
}

TEST(EstimationValues, IsoValueAtTheSmallestSampleGivesAFullBlock) {
    expect_no_edges(changed(ball(), [](float v, const glm::ivec3&) { return v; }), 0);
    EXPECT_NEAR(thickness_along_x(shot_of(ball(), 0)).mean, 20, 5e-3);
}

TEST(EstimationValues, StepOfOneUlpEqualsAnyOtherStep) {
    const float low = 1000, high = std::nextafter(low, 2000.0F);
    const auto step = volume_of({16, 14, 14}, [](const glm::ivec3& v) { return v.x < 8 ? 0.0F : 1.0F; });
    const auto ulp = volume_of({16, 14, 14}, [&](const glm::ivec3& v) { return v.x < 8 ? low : high; });
    const double between = (static_cast<double>(low) + static_cast<double>(high)) / 2;
    EXPECT_EQ(sound(shot_of(step), "a step").color.pixels, sound(shot_of(ulp, between), "an ulp").color.pixels);
    EXPECT_EQ(estimate(ulp, {between}, EdgeEstimator::March).differing(), 0);
}

TEST(EstimationValues, OneUlpInALargeRangeGivesNoEdge) {
    // Below the minimum gradient (method.md): a change of one ulp at the iso-value has no direction.
    const float base = 0.5F, next = std::nextafter(base, 1.0F);
    const auto wobble = volume_of({16, 16, 16}, [&](const glm::ivec3& v) {
        if (v == glm::ivec3(0)) return 0.0F;
        if (v == glm::ivec3(15)) return 1.0F;
        return (v.x + v.y + v.z) % 2 == 0 ? base : next;
    });
    Shot shot = shot_of(wobble, static_cast<double>(next));
    sound(shot, "a wobble");
    for (const EdgeEstimator estimator : kEstimators) {
        const Estimate e = estimate(wobble, {static_cast<double>(next)}, estimator);
        for (int z = 0; z < 16; ++z)
            for (int y = 0; y < 16; ++y)
                for (int x = 0; x < 16; ++x) {
                    const bool next_to_extremes = x + y + z < 12 || x + y + z > 33;
                    EXPECT_FALSE(e.at({x, y, z}).has_edge && !e.at({x, y, z}).border && !next_to_extremes)
                        << x << " " << y << " " << z;
                }
    }
}

TEST(EstimationValues, ScaledBy1eMinus30) {
    expect_the_balls_picture(1e-30, 0, 90);
}
TEST(EstimationValues, ScaledBy1ePlus30) {
    expect_the_balls_picture(1e30, 0, 90);
}
TEST(EstimationValues, Negative) {
    expect_the_balls_picture(40, -1024, 70);
}
TEST(EstimationValues, OverTheWholeRangeOfFloats) {
    expect_the_balls_picture(6.8e38, -3.4e38, 90);
}
TEST(EstimationValues, SmallChangesOnALargeOffset) {
    expect_the_balls_picture(4096, 1e6, 60);  // steps of 1/16: 16 bits of the value remain
}

TEST(EstimationValues, Denormal) {
    // 1e-41 is 7136 steps of the smallest denormal: 13 bits.
    expect_the_balls_picture(1e-41, 0, 55);
}

TEST(EstimationValues, SingleNanBecomesTheSmallestValue) {
    const glm::ivec3 where(9, 9, 9);
    const auto nan = changed(ball(), [&](float v, const glm::ivec3& at) { return at == where ? kNaNSample : v; });
    const auto hole =
        changed(ball(), [&](float v, const glm::ivec3& at) { return at == where ? ball()->min_value : v; });
    EXPECT_EQ(nan->non_finite_count, 1U);
    EXPECT_EQ(sound(shot_of(nan), "NaN").color.pixels, sound(shot_of(hole), "hole").color.pixels);
}

TEST(EstimationValues, SingleInfinityDoesNotChangeTheRange) {
    for (const float infinity : {kInfinity, -kInfinity}) {
        const auto bad =
            changed(ball(), [&](float v, const glm::ivec3& at) { return at == glm::ivec3(2) ? infinity : v; });
        EXPECT_EQ(bad->non_finite_count, 1U);
        EXPECT_EQ(bad->max_value, ball()->max_value);
        EXPECT_GE(compare_images(sound(shot_of(bad), "infinity").color, sound(shot_of(ball()), "ball").color).psnr, 90);
    }
}

TEST(EstimationValues, SlabOfNanIsCutOut) {
    const auto nan =
        changed(ball(), [&](float v, const glm::ivec3& at) { return at.x >= 8 && at.x < 11 ? kNaNSample : v; });
    const auto gap =
        changed(ball(), [&](float v, const glm::ivec3& at) { return at.x >= 8 && at.x < 11 ? ball()->min_value : v; });
    const Image color = sound(shot_of(nan), "NaN").color;
    EXPECT_EQ(color.pixels, sound(shot_of(gap), "gap").color.pixels);
    EXPECT_NEAR(thickness_along_x(shot_of(nan)).most, 2 * 5.3 - 3, 1);
}

TEST(EstimationValues, OnlyNanShowsNothing) {
    for (const float bad : {kNaNSample, kInfinity, -kInfinity}) {
        const auto nothing = volume_of({8, 9, 10}, [&](const glm::ivec3&) { return bad; });
        EXPECT_EQ(nothing->non_finite_count, 720U);
        expect_no_edges(nothing, 0.5);
        EXPECT_EQ(middle_of(sound(shot_of(nothing), "nothing").color, 3).most, 0);
    }
}

TEST(EstimationValues, OneFiniteSampleAmongNan) {
    const auto one = volume_of({9, 9, 9}, [](const glm::ivec3& v) { return v == glm::ivec3(4) ? 3.0F : kNaNSample; });
    EXPECT_EQ(one->min_value, 3);
    EXPECT_EQ(one->max_value, 3);
    const auto thickness = thickness_along_x(shot_of(one, 2.5));
    EXPECT_GT(thickness.most, 0.3);
    EXPECT_LT(thickness.most, 1.6) << "only one voxel is drawn";
}

/// Largest distance of the estimated planes to x = `edge`, over the voxels within reach.
double plane_error(const VolumePointer& volume, double iso_value, double edge, EdgeEstimator estimator) {
    const Estimate e = estimate(volume, {iso_value}, estimator);
    EXPECT_LE(e.differing(), 0.015) << name_of(estimator);
    double worst = 0;
    int found = 0;
    for (int x = 1; x < e.dims.x - 1; ++x) {
        const auto& voxel = e.at({x, e.dims.y / 2, e.dims.z / 2});
        if (!voxel.has_edge || std::abs(x - edge) > 1.6) continue;
        worst = std::max(worst, std::abs(x + voxel.n.x * voxel.D - edge));
        ++found;
    }
    EXPECT_GE(found, 1) << name_of(estimator) << ": no edge";
    return worst;
}

TEST(EstimationValues, SteepRampOf8BitsIsPlacedWithinAStep) {
    // 12 levels per voxel: a level is 1/12 of a voxel.
    const double slope = 12 / 255.0;
    const auto ramp = volume_of({24, 9, 9}, [&](const glm::ivec3& v) {
        return static_cast<float>(std::round(std::clamp(0.5 + (v.x - 11.3) * slope, 0.0, 1.0) * 255) / 255);
    });
    for (const EdgeEstimator estimator : {EdgeEstimator::March, EdgeEstimator::Cubic})
        EXPECT_LE(plane_error(ramp, 0.5, 11.3, estimator), 1.0 / 12) << name_of(estimator);
}

TEST(EstimationValues, FlatRampOf8BitsIsPlacedWithinItsStairs) {
    // 0.7 levels per voxel: stairs of one and two voxels. The iso-value between two levels is crossed once.
    const auto ramp = volume_of(
        {24, 9, 9}, [](const glm::ivec3& v) { return static_cast<float>(std::round(128 + (v.x - 11.3) * 0.7)); });
    const double iso = 128.5, truth = 11.3 + 0.5 / 0.7;
    for (const EdgeEstimator estimator : {EdgeEstimator::March, EdgeEstimator::Cubic})
        EXPECT_LE(plane_error(ramp, iso, truth, estimator), 0.5 / 0.7 + 0.3) << name_of(estimator);
}

TEST(EstimationValues, BinaryHalfSpaceHasItsEdgeHalfWay) {
    const auto binary = volume_of({16, 9, 9}, [](const glm::ivec3& v) { return v.x < 8 ? 0.0F : 1.0F; });
    for (const EdgeEstimator estimator : {EdgeEstimator::March, EdgeEstimator::Cubic})
        EXPECT_LE(plane_error(binary, 0.5, 7.5, estimator), 0.05) << name_of(estimator);
    EXPECT_NEAR(thickness_along_x(shot_of(binary)).mean, 8, 0.1);
}

TEST(EstimationValues, LabelsThatTouchAcrossTwoIsoValues) {
    // 0 and 2 are adjacent: both iso-values lie between the same two voxels. Elsewhere the values are 0, 1, 2.
    const auto labels = volume_of({20, 12, 12}, [](const glm::ivec3& v) {
        if (v.x < 8) return 0.0F;
        return v.x < 11 && v.y < 6 ? 1.0F : 2.0F;
    });
    Shot shot = shot_of(labels);
    shot.scene.iso_values = {0.5, 1.5};
    shot.scene.materials = {{}, {{0.2, 0.4, 1}, 0.3}, {{1, 0.8, 0.6}, 3}};
    expect_as_reference(shot, "labels", 0.02);
    const Estimate e = estimate(labels, {0.5, 1.5}, EdgeEstimator::March);
    EXPECT_TRUE(e.at({8, 2, 6}).has_edge);
    EXPECT_TRUE(e.at({8, 9, 6}).has_edge);
    EXPECT_NEAR(e.at({8, 9, 6}).D, 0.25, 0.05) << "1.5 is a quarter of the way from 2 to 0";
}

TEST(EstimationValues, Checkerboard) {
    const auto board =
        volume_of({12, 12, 12}, [](const glm::ivec3& v) { return ((v.x + v.y + v.z) & 1) == 0 ? 0.0F : 1.0F; });
    // The field has an extremum at every voxel's centre: other rounding finds another surface.
    expect_as_reference(shot_of(board), "checkerboard", 0.03);
    // Half of the voxels are full: rays through the whole block pass half of its thickness.
    Shot plain = shot_of(board);
    plain.settings.edges = EdgeEstimator::Off;
    EXPECT_NEAR(thickness_along_x(plain).mean, 6, 0.02);
    const double faces = thickness_along_x(shot_of(board)).mean;
    EXPECT_GE(faces, 5) << "each voxel has its own face";
    EXPECT_LE(faces, 7.2);
}

/// Matter as thin as a voxel, with a little noise that breaks the symmetry. Voxels beside it carry the part that its
/// own voxels do not reach.
TEST(EstimationValues, FineMatterIsMostlyKept) {
    constexpr int n = 20;
    using Pattern = std::function<int(const glm::ivec3&)>;
    struct Fine {
        const char* name;
        Pattern pattern;  ///< odd values are matter
        float noise;
        double least, most;
    };
    const Fine all[] = {
        {"noise", [](const glm::ivec3&) { return 0; }, 4, 0.9, 1.1},
        {"board", [](const glm::ivec3& v) { return v.x + v.y + v.z; }, 0.01F, 0.93, 1.02},
        {"columns along", [](const glm::ivec3& v) { return v.y + v.z; }, 0.01F, 0.95, 1.02},
        {"columns across", [](const glm::ivec3& v) { return v.x + v.y; }, 0.01F, 0.95, 1.02},
        {"sheets across", [](const glm::ivec3& v) { return v.x; }, 0.01F, 0.97, 1.02},
    };
    for (const Fine& fine : all) {
        std::uint32_t random = 20260301;
        const auto uniform = [&] {
            random = random * 1664525U + 1013904223U;
            return static_cast<float>(random >> 8U) / 16777216.0F - 0.5F;
        };
        const auto volume = volume_of({n, n, n}, [&](const glm::ivec3& v) {
            return static_cast<float>(fine.pattern(v) & 1) - 0.5F + fine.noise * (uniform() + uniform() + uniform());
        });
        Shot shot = shot_of(volume, 0);
        const double faces = thickness_along_x(shot).mean;
        shot.settings.edges = EdgeEstimator::Off;
        const double share = faces / thickness_along_x(shot).mean;
        std::printf("%-16s %.2f of the matter\n", fine.name, share);
        EXPECT_GE(share, fine.least) << fine.name;
        EXPECT_LE(share, fine.most) << fine.name;
    }
}

TEST(EstimationValues, Noise) {
    std::uint32_t random = 20260301;
    const auto noise = volume_of({16, 16, 16}, [&](const glm::ivec3&) {
        random = random * 1664525U + 1013904223U;
        return static_cast<float>(random >> 8U) / 16777216.0F;
    });
    expect_as_reference(shot_of(noise), "noise", 0.05, 55);
    for (const EdgeEstimator estimator : kEstimators) {
        for (const auto& edge : estimate(noise, {0.5}, estimator).device) {
            if (!edge.has_edge) continue;
            ASSERT_NEAR(glm::length(edge.n), 1, 1e-6);
            const bool step = estimator == EdgeEstimator::Taylor;
            ASSERT_GE(edge.D, step ? 0 : -1.251);
            ASSERT_LE(edge.D, step ? edge_reach({}) + 0.01 : 1.251);
        }
    }
}

}  // namespace
}  // namespace edgesplat::test

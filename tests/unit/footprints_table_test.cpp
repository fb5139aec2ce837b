// Footprints from the table, compared with the integrals that it samples.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>

#include "footprints/footprint_table.h"
#include "footprints/plane_face.h"
#include "shaders/shared/footprint_table.h"
#include "tests/unit/footprints_samples.h"

namespace edgesplat {
namespace {

using samples::rays;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Accurate to 1e-5 of the peak. The integrand has a kink where the depth of sampling reaches its minimum.
double exact(const Ray& ray, double distance, double depth) {
    const FacePath path(plane_face(ray, distance), face_cut(distance, 0, 0, kInfinity, depth, kernel_of_table(depth)),
                        kNoCrease, kernel_of_table(depth));
    const double bends = (distance - depth - ray.pn) / ray.un;
    return path.footprint(24, {.high = bends}).integral + path.footprint(24, {.low = bends}).integral;
}

/// Of the four blended layers, only the one with the largest weight.
FootprintLayer without_blend(FootprintLayer layer) {
    constexpr std::uint32_t kMask = (1U << shader::TABLE_BLEND_BITS) - 1;
    const auto nearest = [&](std::uint32_t bits) {
        return (layer.code >> bits & kMask) > kMask / 2 ? kMask << bits : 0;
    };
    layer.code = (layer.code & kMask) | nearest(shader::TABLE_BLEND_BITS) | nearest(2 * shader::TABLE_BLEND_BITS);
    return layer;
}

struct Statistics {
    double largest = 0, squares = 0;
    int count = 0;
    void add(double error) {
        largest = std::max(largest, std::abs(error));
        squares += error * error;
        ++count;
    }
    double rms() const { return std::sqrt(squares / count); }
};

class FootprintTableDepth : public testing::TestWithParam<double> {
  protected:
    const Kernel& kernel_ = kernel_of_table(GetParam());
    const double radius_ = kernel_.radius, peak_ = kernel_footprint(0, kernel_);
};

TEST_P(FootprintTableDepth, TabulatesKernelsCutByPlaneFaces) {
    const double depth = GetParam();
    const FootprintTable& table = kept_footprint_table(depth);
    Statistics blended, nearest;
    for (const auto& [distance, ray] : rays(40000, depth - radius_, depth + radius_, 71)) {
        if (ray.un < 1e-3) continue;  // a step: EdgeOnFaceIsStep tests its position
        const double sine = std::sqrt(1 - ray.un * ray.un), x = sine > 0 ? ray.pn / sine : 0;
        const double y = std::sqrt(std::max(ray.rho2 - x * x, 0.0)), want = exact(ray, distance, depth);
        const FootprintLayer layer = select_footprint_layer(distance, ray.un, depth);
        blended.add((table.lookup(layer, x, y) - want) / peak_);
        nearest.add((table.lookup(without_blend(layer), x, y) - want) / peak_);
    }
    std::printf("depth %.1f, %% of the peak, largest / rms: blended %.2f / %.3f, nearest layer %.2f / %.3f\n", depth,
                100 * blended.largest, 100 * blended.rms(), 100 * nearest.largest, 100 * nearest.rms());
    EXPECT_LE(blended.rms(), 0.004);
    EXPECT_LE(blended.largest, 0.06);
    EXPECT_GT(nearest.rms(), 3 * blended.rms()) << "blending no longer reduces the error";
}

TEST_P(FootprintTableDepth, PlainLayerIsPlainFootprint) {
    const FootprintLayer plain = plain_footprint_layer(GetParam());
    const FootprintTable& table = kept_footprint_table(GetParam());
    double largest = 0;
    for (int i = 0; i <= 1000; ++i) {
        const double rho = 1.7 * i / 1000;
        largest =
            std::max(largest, std::abs(table.lookup(plain, 0, rho) - kernel_footprint(rho * rho, kernel_)) / peak_);
    }
    std::printf("depth %.1f, %% of the peak, largest: plain layer %.2f\n", GetParam(), 100 * largest);
    EXPECT_LE(largest, 0.004);
    // A face that cuts nothing selects the plain layer.
    for (const double distance : {radius_ + GetParam(), 5.0})
        EXPECT_EQ(select_footprint_layer(distance, 1, GetParam()).code, plain.code);
}

TEST_P(FootprintTableDepth, EdgeOnFaceIsStep) {
    const double depth = GetParam();
    const FootprintTable& table = kept_footprint_table(depth);
    for (double distance = depth - 0.75 * radius_; distance < depth + 0.75 * radius_; distance += 0.073) {
        const FootprintLayer layer = select_footprint_layer(distance, 0, depth);
        EXPECT_EQ(layer.cosine, 0);
        for (const double y : {0.0, 0.31, 0.5}) {
            const double e = distance - depth, inside = kernel_footprint(e * e + y * y, kernel_);
            EXPECT_EQ(table.lookup(layer, distance + 5e-4, y), 0) << distance << " " << y;
            EXPECT_NEAR(table.lookup(layer, distance - 5e-4, y), inside, 0.02 * peak_) << distance << " " << y;
        }
    }
}

TEST_P(FootprintTableDepth, KernelIsZeroBeyondFace) {
    const FootprintTable& table = kept_footprint_table(GetParam());
    for (const double distance : {GetParam() - radius_, -2.5})
        for (const double cosine : {0.0, 0.4, 1.0})
            for (const double x : {-1.5, -0.2, 0.0, 0.7})
                EXPECT_NEAR(table.lookup(select_footprint_layer(distance, cosine, GetParam()), x, 0.1), 0, 1e-6);
}

TEST_P(FootprintTableDepth, CodesDescribeFacePosition) {
    const double depth = GetParam();
    for (const double cosine : {0.0, 0.013, 0.5, 0.77, 0.999, 1.0}) {
        for (double distance = depth - radius_; distance <= depth + radius_; distance += 0.01) {
            const FootprintLayer layer = select_footprint_layer(distance, cosine, depth);
            const double e = distance - depth;
            EXPECT_NEAR(layer.cosine, cosine, 1e-4);
            EXPECT_NEAR(layer.middle, distance * std::sqrt(1 - layer.cosine * layer.cosine), 1e-4);
            EXPECT_NEAR(layer.rim2, radius_ * radius_ - e * e, 4e-4);
            EXPECT_LT(layer.code & 1023U, shader::TABLE_LAYERS - shader::TABLE_DIRECTIONS);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Depths, FootprintTableDepth, testing::Values(FACE_DEPTH, 0.0),
                         [](const auto& test) { return test.param == FACE_DEPTH ? "opaque" : "translucent"; });

TEST(FootprintTable, IsMadeOnceAndHasOneSize) {
    const FootprintTable& table = kept_footprint_table(FACE_DEPTH);
    EXPECT_EQ(&table, &kept_footprint_table(FACE_DEPTH));
    EXPECT_EQ(table.texels().size(), std::size_t{shader::TABLE_LAYERS} * shader::TABLE_ROWS * shader::TABLE_WIDTH);
}

TEST(HalfFloats, RoundToNearest) {
    for (const float value : {0.0F, 1e-8F, 6e-8F, 1e-5F, 6.1e-5F, 0.1F, 0.3337F, 1.0F, 1.9997F, 100.0F, 65000.0F}) {
        const std::uint16_t half = half_from_float(value);
        const double error = std::abs(static_cast<double>(float_from_half(half)) - static_cast<double>(value));
        for (const int step : {-1, 1}) {
            const int neighbour = half + step;
            if (neighbour < 0) continue;
            const float other = float_from_half(static_cast<std::uint16_t>(neighbour));
            EXPECT_LE(error, std::abs(static_cast<double>(other) - static_cast<double>(value))) << value;
        }
    }
}

}  // namespace
}  // namespace edgesplat

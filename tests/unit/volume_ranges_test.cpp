// Values from 1e-60 to 1e60 behave like values from 0 to 1, and are written with the digits that tell them apart.
#include <array>
#include <cmath>

#include "engine/volume/filters.h"
#include "engine/volume/value_text.h"
#include "tests/unit/volume_test_files.h"

namespace {

using namespace edgesplat;
using testing::ElementsAre;

class VolumeRanges : public volume_test::FolderTest {
  protected:
    /// A blurred ball from 0 to `scale`, stored as float64.
    Volume ball_of(double scale, double offset = 0) {
        constexpr int n = 20;
        std::vector<double> values;
        for (int z = 0; z < n; ++z)
            for (int y = 0; y < n; ++y)
                for (int x = 0; x < n; ++x) {
                    const double r = glm::length(glm::dvec3(x, y, z) - (n - 1) / 2.0);
                    values.push_back(offset + scale * (0.5 * std::erfc((r - 6) / 1.2) + 1e-3 * x / n));
                }
        LoadOptions options;
        options.raw = "20x20x20:float64:little";
        return load_volume(write("ball.raw", {reinterpret_cast<const char*>(values.data()), 8 * values.size()}),
                           options);
    }
};

TEST_F(VolumeRanges, OfAnySizeGiveTheSameFieldAndSuggestions) {
    const Volume usual = ball_of(1);
    EXPECT_EQ(usual.value_scale, 1);
    const std::vector<float> field = scaled_field(usual);
    const auto expected = suggest_iso_values(usual);
    ASSERT_FALSE(expected.empty());
    for (const double scale : {1e-60, 1e-30, 1e-16, 1e16, 1e30, 1e60}) {
        const Volume volume = ball_of(scale);
        EXPECT_EQ(volume.non_finite_count, 0U);
        EXPECT_NEAR(volume.in_file_unit(static_cast<double>(volume.max_value)) / scale, 1, 2e-3) << scale;
        const std::vector<float> scaled = scaled_field(volume);
        for (std::size_t i = 0; i < field.size(); ++i)
            ASSERT_NEAR(scaled[i], field[i], 3e-7) << scale;
        const auto found = suggest_iso_values(volume);
        ASSERT_EQ(found.size(), expected.size()) << scale;
        for (std::size_t i = 0; i < found.size(); ++i) {
            EXPECT_NEAR(volume.in_file_unit(found[i].value) / scale, expected[i].value, 5e-3) << scale;
            EXPECT_NEAR(found[i].strength, expected[i].strength, 1e-3) << scale;
        }
    }
}

TEST_F(VolumeRanges, FillValuesScaleNoData) {
    std::vector<double> values(1000, 9.96921e36);
    for (std::size_t i = 0; i < 500; ++i)
        values[i] = static_cast<double>(i % 50);
    LoadOptions options;
    options.raw = "10x10x10:float64:little";
    const Volume volume =
        load_volume(write("fill.raw", {reinterpret_cast<const char*>(values.data()), 8 * values.size()}), options);
    EXPECT_EQ(volume.value_scale, 1);
    EXPECT_EQ(volume.min_value, 0);
    EXPECT_EQ(volume.warnings.size(), 1U);
}

TEST_F(VolumeRanges, ValuesCloseTogetherAreNoted) {
    EXPECT_THAT(ball_of(1, 1e6).notes, testing::Contains(testing::HasSubstr("The values lie close together")));
    EXPECT_THAT(ball_of(1, 0).notes, testing::Not(testing::Contains(testing::HasSubstr("close together"))));
}

TEST(ValueText, HasTheDigitsThatTellValuesApart) {
    Volume volume;
    EXPECT_EQ(value_text(volume, 0.1F), "0.1");
    EXPECT_EQ(value_text(volume, -9999), "-9999");
    EXPECT_EQ(value_text(volume, 9.96921e36F), "9.96921e+36");
    EXPECT_EQ(value_text(volume, 1000000.125F), "1000000.1");
    EXPECT_EQ(value_text(volume, 0), "0");
    EXPECT_EQ(value_text(volume, 100000), "100000");
    volume.value_scale = std::ldexp(1.0, 199);
    EXPECT_EQ(value_text(volume, static_cast<float>(std::ldexp(1e60, -199))), "1e+60");

    EXPECT_EQ(value_text(300.25, 4000), "300.25");
    EXPECT_EQ(value_text(0.1 + 0.2, 1), "0.3");
    EXPECT_EQ(value_text(1e6 + 0.3, 1), "1000000.3");
    const std::array close{1000000.1, 1000000.2, 1000000.3};
    EXPECT_THAT(value_texts(close, 1e6), ElementsAre("1000000.1", "1000000.2", "1000000.3"));
    const std::array usual{0.25, 300.0};
    EXPECT_THAT(value_texts(usual, 300), ElementsAre("0.25", "300"));
    EXPECT_EQ(value_digits(4000, 4000), 5);
    EXPECT_EQ(value_digits(1e6, 1), 11);
}

}  // namespace

// `edgesplat measure` from end to end.
#include <gmock/gmock.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

#include "tests/unit/cli_program.h"

namespace edgesplat {
namespace {

using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::IsEmpty;

class CliMeasure : public CliTest {
  protected:
    std::string good(const std::string& arguments) const {
        const ProgramRun result = run("measure " + arguments);
        EXPECT_EQ(result.status, 0) << arguments << '\n' << result.err;
        EXPECT_THAT(result.err, IsEmpty());
        return result.out;
    }
    void refuses(const std::string& arguments, int status, const std::string& words) const {
        const ProgramRun result = run("measure " + arguments);
        EXPECT_EQ(result.status, status) << arguments;
        EXPECT_THAT(result.err, HasSubstr(words)) << arguments;
        EXPECT_THAT(result.out, IsEmpty());
        EXPECT_THAT(files(), IsEmpty());
    }
    /// Expects "BEFORE: VALUE ± UNCERTAINTY" in the text; the truth must lie in this range.
    static void expect_measured(const std::string& text, const std::string& before, double truth) {
        const std::size_t at = text.find(before + ": ");
        ASSERT_NE(at, std::string::npos) << before << " in\n" << text;
        double value = 0, uncertainty = 0;
        ASSERT_EQ(std::sscanf(text.c_str() + at + before.size() + 2, "%lf ± %lf", &value, &uncertainty), 2) << text;
        EXPECT_NEAR(value, truth, uncertainty) << before;
        EXPECT_LT(uncertainty, 0.05 * truth) << before;
    }
};

// The builtin sphere has a radius of 20 voxels of 1 mm around 31.7, 31.4, 31.2.
constexpr double kRadius = 20;

TEST_F(CliMeasure, MeasuresVolumesAndSurfaces) {
    const double volume = 4.0 / 3 * std::numbers::pi * std::pow(kRadius, 3);
    const std::string text = good("builtin:sphere");
    expect_measured(text, "volume from 0.5", volume);
    expect_measured(text, "volume below 0.5", std::pow(64, 3) - volume);
    expect_measured(text, "surface at 0.5", 4 * std::numbers::pi * kRadius * kRadius);
    const std::string half = good("builtin:sphere --clip-plane 31.7,31.4,31.2,1,2,3");
    expect_measured(half, "volume from 0.5", volume / 2);
    EXPECT_THAT(good("builtin:sphere --iso 0.3,0.7 --json -"),
                AllOf(HasSubstr("\"volume_mm3\""), HasSubstr("\"area_mm2\""), HasSubstr("\"uncertainty\"")));
}

TEST_F(CliMeasure, MeasuresDistancesAndAngles) {
    // Positions near the sphere's surface, then a pixel that shows its middle from the front.
    const std::string text =
        good("builtin:sphere --view front --size 64x64 --at 52.3,31.4,31.2 --at 31.7,31.4,50.8 --at 11.6,31.4,31.2");
    expect_measured(text, "distance 1 to 2", kRadius * std::numbers::sqrt2);
    expect_measured(text, "distance 2 to 3", kRadius * std::numbers::sqrt2);
    expect_measured(text, "angle at 2", 90);
    EXPECT_THAT(text, HasSubstr("on the surface at 0.5"));
    const std::string seen = good(
        "builtin:sphere --voxel --eye 31.7,-60,31.2 --direction 0,1,0 --size 64x64 --at 32,32 --at 31.7,51.9,31.2");
    expect_measured(seen, "distance 1 to 2", 2 * kRadius);
    const std::string exact = good("builtin:sphere --exact --at 0,0,0 --at 3,4,0");
    EXPECT_THAT(exact, HasSubstr("distance 1 to 2: 5 mm"));
    good("builtin:sphere --at 52.3,31.4,31.2 --json place.json");
    EXPECT_THAT(text_of(folder_ / "place.json"), ContainsRegex("\"iso_value\": 0.5"));
}

TEST_F(CliMeasure, RefusesUnmeasurableInput) {
    refuses("builtin:sphere --at 1,2,3,4", 2, "--at: '1,2,3,4' is neither a position X,Y,Z nor a pixel X,Y");
    refuses("builtin:sphere --at 1,2,", 2, "neither a position");
    refuses("builtin:sphere --at 31.7,31.4,31.2", 1, "no surface is within 2 voxels");
    refuses("builtin:sphere --at 0,0 --view front --size 64x64", 1, "no surface is visible at this pixel of 64x64");
    refuses("builtin:sphere --at 52,31,31 --json out.txt", 1, "out.txt");
    refuses("builtin:sphere --exact --at 1,1,1 --at 1,1,1 --at 2,2,2", 1, "two of its three points are equal");
}

}  // namespace
}  // namespace edgesplat

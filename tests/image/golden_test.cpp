// Compares pictures of any device with the lavapipe pictures in tests/image/golden. `accept` shows the differences and
// replaces pictures on demand.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "engine/forecast/effect_table.h"
#include "engine/image/image_file.h"
#include "engine/renderer.h"
#include "tests/image/image_cases.h"

namespace edgesplat::test {
namespace {

// Tolerance of a displayed (sRGB) channel, and the largest share of pixels that may exceed it: where a ray only touches
// a face, rounding decides, and drivers round differently.
constexpr double kSameChannel = 8.0 / 255;
constexpr double kOtherPixels = 0.002;
// Such pixels are single ones, on outlines. The largest mean difference of 3 x 3 pixels allows one of them, or a few
// that differ less; a hole of four pixels exceeds it.
constexpr double kWindow = 0.12;

/// The largest mean difference of a channel over 3 x 3 pixels.
double largest_window(const Image& a, const Image& b) {
    double largest = 0;
    for (int y = 0; y + 2 < a.height; ++y)
        for (int x = 0; x + 2 < a.width; ++x)
            for (int c = 0; c < a.channels; ++c) {
                double sum = 0;
                for (int i = 0; i < 9; ++i) {
                    const int column = x + i % 3, row = y + i / 3;
                    sum += std::abs(static_cast<double>(a.at(column, row, c) - b.at(column, row, c)));
                }
                largest = std::max(largest, sum / 9);
            }
    return largest;
}

/// sRGB values of a picture in linear light.
Image displayed(Image image) {
    for (float& v : image.pixels)
        v = v <= 0.0031308F ? 12.92F * v : 1.055F * std::pow(v, 1 / 2.4F) - 0.055F;
    return image;
}

/// The displayed picture. A background of two colours is part of it, so it has no alpha then.
Image seen(const ImageCase& c) {
    const Image image = render_on_device(c);
    if (!c.shot.scene.effects.background_top) return image;
    Image opaque(image.width, image.height, 3);
    for (std::size_t i = 0; i < opaque.pixels.size(); ++i)
        opaque.pixels[i] = image.pixels[i / 3 * 4 + i % 3];
    return opaque;
}

class Golden : public testing::TestWithParam<ImageCase> {};

TEST_P(Golden, MatchesStoredPicture) {
    if (const std::string why = refusal_of_layers(GetParam()); !why.empty()) GTEST_SKIP() << why;
    // Pictures of a forced device profile have their own folder.
    const char* profile = std::getenv("EDGESPLAT_DEVICE_PROFILE");
    const auto folder = std::filesystem::path(EDGESPLAT_PICTURES) / (profile == nullptr ? "" : profile);
    const auto golden = std::filesystem::path(EDGESPLAT_SOURCE_DIR) / "tests/image/golden" / (GetParam().name + ".png");
    const auto actual = folder / (GetParam().name + ".png"), diff = folder / (GetParam().name + ".diff.png");
    std::filesystem::create_directories(folder);
    write_image(actual, seen(GetParam()));
    ASSERT_TRUE(std::filesystem::exists(golden))
        << "no golden picture yet; check " << actual << ", then run tests/image/accept";
    const Image a = displayed(read_image(actual).image), b = displayed(read_image(golden).image);
    const ImageDifference difference = compare_images(a, b, kSameChannel);
    const double window = largest_window(a, b);
    if (difference.share > kOtherPixels || window > kWindow) write_image(diff, difference_image(a, b, 10));
    EXPECT_TRUE(difference.share <= kOtherPixels && window <= kWindow)
        << difference.share << " of the pixels differ, a window by " << window << "; largest difference "
        << difference.max << " at " << difference.x << ", " << difference.y << "\n"
        << "picture:    " << actual << "\ngolden:     " << golden << "\ndifference: " << diff
        << " (x10)\nmade by:    " << fmt::format("image_tests --gtest_filter='*/{}'", GetParam().name)
        << "\nto accept:  tests/image/accept " << EDGESPLAT_PICTURES << " --replace " << GetParam().name;
}

/// The bounds above find a small hole wherever the picture shows matter.
TEST(GoldenBounds, NoticeAHoleOfTwoByTwoPixels) {
    for (const float shown : {0.6F, 1.0F}) {
        Image whole(128, 128, 4);
        std::ranges::fill(whole.pixels, shown);
        Image hole = whole;
        for (const int x : {60, 61})
            for (const int y : {40, 41})
                for (int c = 0; c < 4; ++c)
                    hole.at(x, y, c) = 0;
        EXPECT_LE(compare_images(whole, hole, kSameChannel).share, kOtherPixels);
        EXPECT_GT(largest_window(whole, hole), kWindow);
        Image speck = whole;
        speck.at(60, 40, 0) = 0;
        EXPECT_LE(largest_window(whole, speck), kWindow);
    }
}

INSTANTIATE_TEST_SUITE_P(Pictures, Golden, testing::ValuesIn(golden_cases()),
                         [](const auto& instance) { return instance.param.name; });

TEST(ImageCases, CoverEveryEffect) {
    std::vector<ImageCase> cases = golden_cases();
    for (ImageCase& c : reference_cases())
        cases.push_back(std::move(c));
    for (const Effect& effect : effect_table()) {
        EXPECT_TRUE(std::ranges::any_of(
            cases,
            [&](const ImageCase& c) {
                const Shot& shot = c.shot;
                const AovRequest outputs{.tau = c.output == reference::Output::Tau,
                                         .depth = c.output == reference::Output::Depth,
                                         .normal = c.output == reference::Output::Normal,
                                         .distance = c.output == reference::Output::Distance};
                return !effect.reason({shot.volume, shot.scene, shot.camera, shot.settings, {64, 64}, outputs}).empty();
            }))
            << "no case shows the effect `" << effect.name << "`";
    }
}

}  // namespace
}  // namespace edgesplat::test

// Pictures against those of lavapipe that are kept in tests/image/golden, on any device: `accept` shows what changed
// and replaces on demand.
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

// A channel, as displayed (sRGB), is the same up to this; so many pixels may be further off.
constexpr double kSameChannel = 8.0 / 255;
constexpr double kOtherPixels = 0.005;

/// sRGB values of a picture in linear light.
Image displayed(Image image) {
    for (float& v : image.pixels)
        v = v <= 0.0031308F ? 12.92F * v : 1.055F * std::pow(v, 1 / 2.4F) - 0.055F;
    return image;
}

/// What is seen: with a background of two colours that too, so without alpha.
Image seen(const ImageCase& c) {
    const Image image = render_on_device(c);
    if (!c.shot.scene.effects.background_top) return image;
    Image opaque(image.width, image.height, 3);
    for (std::size_t i = 0; i < opaque.pixels.size(); ++i)
        opaque.pixels[i] = image.pixels[i / 3 * 4 + i % 3];
    return opaque;
}

class Golden : public testing::TestWithParam<ImageCase> {};

TEST_P(Golden, IsTheSame) {
    if (const std::string why = refusal_of_layers(GetParam()); !why.empty()) GTEST_SKIP() << why;
    // Pictures of a profile that is forced lie apart.
    const char* profile = std::getenv("EDGESPLAT_DEVICE_PROFILE");
    const auto folder = std::filesystem::path(EDGESPLAT_PICTURES) / (profile == nullptr ? "" : profile);
    const auto golden = std::filesystem::path(EDGESPLAT_SOURCE_DIR) / "tests/image/golden" / (GetParam().name + ".png");
    const auto actual = folder / (GetParam().name + ".png"), diff = folder / (GetParam().name + ".diff.png");
    std::filesystem::create_directories(folder);
    write_image(actual, seen(GetParam()));
    ASSERT_TRUE(std::filesystem::exists(golden)) << "no golden yet; look at " << actual << ", then tests/image/accept";
    const Image a = displayed(read_image(actual).image), b = displayed(read_image(golden).image);
    const ImageDifference difference = compare_images(a, b, kSameChannel);
    if (difference.share > kOtherPixels) write_image(diff, difference_image(a, b, 10));
    EXPECT_LE(difference.share, kOtherPixels)
        << "largest difference " << difference.max << " at " << difference.x << ", " << difference.y << "\n"
        << "picture:    " << actual << "\ngolden:     " << golden << "\ndifference: " << diff
        << " (x10)\nmade by:    " << fmt::format("image_tests --gtest_filter='*/{}'", GetParam().name)
        << "\nto accept:  tests/image/accept " << EDGESPLAT_PICTURES << " --replace " << GetParam().name;
}

INSTANTIATE_TEST_SUITE_P(Pictures, Golden, testing::ValuesIn(golden_cases()),
                         [](const auto& instance) { return instance.param.name; });

TEST(ImageCases, ShowEveryEffect) {
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
            << "no picture has the effect `" << effect.name << "`";
    }
}

}  // namespace
}  // namespace edgesplat::test

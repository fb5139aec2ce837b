// Compares whole pictures of the device with the double-precision reference.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tests/image/image_cases.h"

namespace edgesplat::test {
namespace {

Image scaled(Image image, double factor) {
    for (float& v : image.pixels)
        v = static_cast<float>(static_cast<double>(v) * factor);
    return image;
}

/// Outputs that are divided by alpha.
bool is_mean(reference::Output output) {
    return output != reference::Output::Color && output != reference::Output::Tau;
}

/// Blanks nearly transparent pixels: their mean depth or normal is the ratio of two rounding errors.
void blank_unseen(Image& image, const Image& color) {
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            for (int c = 0; c < image.channels && color.at(x, y, 3) < 1e-6F; ++c)
                image.at(x, y, c) = 0;
        }
    }
}

class Reference : public testing::TestWithParam<ImageCase> {};

TEST_P(Reference, MatchesDevice) {
    const ImageCase& c = GetParam();
    if (const std::string why = refusal_of_layers(c); !why.empty()) GTEST_SKIP() << why;
    const reference::PreparedVolume prepared(*c.shot.volume, c.shot.scene, c.shot.settings, true);
    Image expected = prepared.render(c.shot.camera, c.shot.width, c.shot.height, c.output);
    Image actual = render_on_device(c);
    if (is_mean(c.output)) {
        const Image color = prepared.render(c.shot.camera, c.shot.width, c.shot.height);
        blank_unseen(expected, color);
        blank_unseen(actual, color);
    }
    double peak = 1;
    for (const float v : expected.pixels)
        peak = std::max(peak, std::abs(static_cast<double>(v)));
    const ImageDifference difference = compare_images(scaled(actual, 1 / peak), scaled(expected, 1 / peak));
    EXPECT_GE(difference.psnr, c.smallest_psnr)
        << "largest " << difference.max << " at " << difference.x << ", " << difference.y;
    EXPECT_GT(evenness(actual).mean * evenness(actual).variation, 0.01) << "the picture is empty";
    std::printf("%-40s %6.1f dB, largest %.4f\n", c.name.c_str(), difference.psnr, difference.max);
}

/// The name of a case for ctest: every character except letters and digits becomes _.
std::string test_name(const testing::TestParamInfo<ImageCase>& instance) {
    std::string name = instance.param.name;
    std::ranges::replace_if(
        name, [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
    return name;
}

INSTANTIATE_TEST_SUITE_P(Cases, Reference, testing::ValuesIn(reference_cases()), test_name);

}  // namespace
}  // namespace edgesplat::test

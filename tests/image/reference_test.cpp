// Whole pictures of the device against the double-precision reference.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/image/image_cases.h"

namespace edgesplat::test {
namespace {

constexpr double kSmallestPsnr = 50;  // dB, of a peak that is the larger of 1 and the reference's largest magnitude

Image scaled(Image image, double factor) {
    for (float& v : image.pixels)
        v = static_cast<float>(static_cast<double>(v) * factor);
    return image;
}

TEST(Reference, EveryCaseAgrees) {
    for (const ImageCase& c : reference_cases()) {
        SCOPED_TRACE(c.name);
        const reference::PreparedVolume prepared(*c.shot.volume, c.shot.scene, c.shot.settings, true);
        const Image expected = prepared.render(c.shot.camera, c.shot.width, c.shot.height, c.output);
        const Image actual = render_on_device(c);
        double peak = 1;
        for (const float v : expected.pixels)
            peak = std::max(peak, std::abs(static_cast<double>(v)));
        const ImageDifference difference = compare_images(scaled(actual, 1 / peak), scaled(expected, 1 / peak));
        EXPECT_GE(difference.psnr, kSmallestPsnr)
            << "largest " << difference.max << " at " << difference.x << ", " << difference.y;
        EXPECT_GT(evenness(actual).mean * evenness(actual).variation, 0.01) << "an empty picture shows nothing";
        std::printf("%-40s %6.1f dB, largest %.4f\n", c.name.c_str(), difference.psnr, difference.max);
    }
}

}  // namespace
}  // namespace edgesplat::test

// Metrics of picture differences, compared with values computed by hand.
#include "engine/image/image_compare.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "engine/error.h"

namespace edgesplat {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(ImageCompare, EqualPicturesHaveNoDifference) {
    const Image image(3, 2, 4);
    const ImageDifference d = compare_images(image, image);
    EXPECT_EQ(d.rmse, 0);
    EXPECT_EQ(d.max, 0);
    EXPECT_EQ(d.share, 0);
    EXPECT_TRUE(std::isinf(d.psnr));
}

TEST(ImageCompare, MeasuresOneChannelOfOnePixel) {
    const Image a(4, 2, 2);
    Image b = a;
    b.at(3, 1, 1) = -0.5F;
    const ImageDifference d = compare_images(a, b, 0.1);
    EXPECT_DOUBLE_EQ(d.rmse, 0.5 / std::sqrt(16.0));
    EXPECT_DOUBLE_EQ(d.max, 0.5);
    EXPECT_NEAR(d.psnr, 20 * std::log10(8.0), 1e-12);
    EXPECT_DOUBLE_EQ(d.share, 1.0 / 8);
    EXPECT_EQ(d.x, 3);
    EXPECT_EQ(d.y, 1);
    EXPECT_EQ(d.channel, 1);
    EXPECT_EQ(compare_images(a, b, 0.5).share, 0) << "a difference equal to the tolerance is within it";
}

TEST(ImageCompare, NanNeverPasses) {
    const Image a(1, 1, 1);
    Image b = a;
    b.pixels[0] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_TRUE(std::isinf(compare_images(a, b, 10).max));
    EXPECT_EQ(compare_images(a, b, 10).share, 1);
    EXPECT_EQ(compare_images(b, b).max, 0);
}

TEST(ImageCompare, RefusesDifferentShapes) {
    EXPECT_THAT([] { compare_images(Image(2, 2, 3), Image(2, 3, 3)); }, ThrowsMessage<Error>(HasSubstr("2 x 3")));
    EXPECT_THAT([] { compare_images(Image(2, 2, 3), Image(2, 2, 4)); }, ThrowsMessage<Error>(HasSubstr("channels")));
}

TEST(ImageCompare, DifferencePictureOmitsAlpha) {
    const Image a(1, 1, 4);
    Image b = a;
    b.pixels = {0.25F, 0, -0.5F, 1};
    const Image d = difference_image(a, b, 2);
    ASSERT_EQ(d.channels, 3);
    EXPECT_THAT(d.pixels, ::testing::ElementsAre(0.5F, 0.0F, 1.0F));
}

}  // namespace
}  // namespace edgesplat

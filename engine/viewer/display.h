// Pictures as a window shows them.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/image/image.h"

namespace edgesplat::viewer {

/// (height, width, 4) bytes, sRGB, opaque.
struct ScreenPicture {
    int width = 0, height = 0;
    std::vector<std::uint8_t> pixels;
};

/// The picture's colours, of which the background is a part already; NaN is shown as black.
ScreenPicture screen_picture(const Image& image);

/// Where edges were sharpened and how much: `image` in grey, and over it the difference to `plain` (largest of the
/// sRGB channels), from blue (1/16 of full scale) over yellow to red (a quarter and more). Equal sizes.
ScreenPicture sharpening_picture(const Image& image, const Image& plain);

/// RMS over pixels and colours of `small`, spread bilinearly over the size of `large`, against it, of sRGB full scale:
/// what a picture that was drawn in haste is off by.
double rms_when_spread(const Image& small, const Image& large);

}  // namespace edgesplat::viewer

// Converts pictures for display in a window.
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

/// Converts a picture, which contains its background already, to sRGB; NaN becomes black.
ScreenPicture screen_picture(const Image& image);

/// Shows where edges were sharpened and how much. Over `image` in grey lies the difference to `plain` (largest of the
/// sRGB channels), from blue (1/16 of full scale) over yellow to red (1/4 and more). Throws Error unless both have the
/// same size.
ScreenPicture sharpening_picture(const Image& image, const Image& plain);

/// RMS difference over pixels and colours, as a share of sRGB full scale, between `large` and `small`, which is scaled
/// bilinearly to the size of `large`: the error of a coarse picture.
double rms_after_upscaling(const Image& small, const Image& large);

}  // namespace edgesplat::viewer

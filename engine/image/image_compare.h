// Measures the difference between two images.
#pragma once

#include "engine/image/image.h"

namespace edgesplat {

/// Difference over all channels, in the images' own colour space (linear light for `read_image`).
struct ImageDifference {
    double rmse = 0;                ///< root mean square of the difference
    double max = 0;                 ///< largest absolute difference; infinite if only one of two values is NaN
    double psnr = 0;                ///< 20 log10(1 / rmse) in dB, for a peak of 1; infinite for equal pictures
    double share = 0;               ///< share of pixels, 0..1, with a channel further apart than the tolerance
    int x = 0, y = 0, channel = 0;  ///< first position of `max`
};

/// Throws Error if size or number of channels differ.
ImageDifference compare_images(const Image& a, const Image& b, double tolerance = 0);

/// abs(a - b) * gain per colour channel, without alpha: an image of 1 or 3 channels. Throws Error like
/// `compare_images`.
Image difference_image(const Image& a, const Image& b, double gain = 1);

}  // namespace edgesplat

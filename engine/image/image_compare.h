// How far two pictures are apart.
#pragma once

#include "engine/image/image.h"

namespace edgesplat {

/// Over all channels, in the space the pictures are in (linear light for what `read_image` returns).
struct ImageDifference {
    double rmse = 0;   ///< root mean square of the difference
    double max = 0;    ///< largest absolute difference; infinite where one picture has NaN and the other has not
    double psnr = 0;   ///< 20 log10(1 / rmse) in dB, for a peak of 1; infinite for equal pictures
    double share = 0;  ///< share of pixels, 0..1, with a channel further apart than the tolerance
    int x = 0, y = 0, channel = 0;  ///< where `max` occurs first
};

/// Throws Error when the pictures differ in size or number of channels.
ImageDifference compare_images(const Image& a, const Image& b, double tolerance = 0);

/// abs(a - b) * gain per colour channel, without alpha, as a picture of 1 or 3 channels to look at. Throws Error like
/// `compare_images`.
Image difference_image(const Image& a, const Image& b, double gain = 1);

}  // namespace edgesplat

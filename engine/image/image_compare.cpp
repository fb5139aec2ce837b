#include "engine/image/image_compare.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/error.h"

namespace edgesplat {
namespace {

void check_same_shape(const Image& a, const Image& b) {
    if (a.width != b.width || a.height != b.height)
        fail("the pictures differ in size: {} x {} and {} x {} pixels", a.width, a.height, b.width, b.height);
    if (a.channels != b.channels)
        fail("the pictures differ in their number of channels: {} and {}", a.channels, b.channels);
}

/// Absolute difference; 0 for equal infinities or two NaN, infinite if one value is NaN.
double distance(float a, float b) {
    if (a == b || (std::isnan(a) && std::isnan(b))) return 0;
    const double d = std::abs(static_cast<double>(a) - static_cast<double>(b));
    return std::isnan(d) ? std::numeric_limits<double>::infinity() : d;
}

}  // namespace

ImageDifference compare_images(const Image& a, const Image& b, double tolerance) {
    check_same_shape(a, b);
    ImageDifference result;
    double sum = 0;
    std::size_t beyond = 0;
    for (int y = 0; y < a.height; ++y) {
        for (int x = 0; x < a.width; ++x) {
            double worst = 0;
            for (int c = 0; c < a.channels; ++c) {
                const double d = distance(a.at(x, y, c), b.at(x, y, c));
                sum += d * d;
                worst = std::max(worst, d);
                if (d > result.max) {
                    result.max = d;
                    result.x = x;
                    result.y = y;
                    result.channel = c;
                }
            }
            if (worst > tolerance) ++beyond;
        }
    }
    const double pixels = static_cast<double>(a.width) * a.height;
    if (pixels > 0) {
        result.rmse = std::sqrt(sum / (pixels * a.channels));
        result.share = static_cast<double>(beyond) / pixels;
    }
    result.psnr = result.rmse > 0 ? -20 * std::log10(result.rmse) : std::numeric_limits<double>::infinity();
    return result;
}

Image difference_image(const Image& a, const Image& b, double gain) {
    check_same_shape(a, b);
    Image out(a.width, a.height, a.channels >= 3 ? 3 : 1);
    for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < a.width; ++x)
            for (int c = 0; c < out.channels; ++c)
                out.at(x, y, c) = static_cast<float>(gain * distance(a.at(x, y, c), b.at(x, y, c)));
    return out;
}

}  // namespace edgesplat

#include "engine/viewer/display.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/error.h"
#include "engine/image/srgb.h"

namespace edgesplat::viewer {
namespace {

constexpr int kSteps = 4096;  // of the curve's table: finer than an 8-bit step, except in the darkest two

/// The sRGB curve as a function of the value's square root, in which it is nearly straight.
const std::array<std::uint8_t, kSteps + 1>& curve() {
    static const auto table = [] {
        std::array<std::uint8_t, kSteps + 1> out{};
        for (std::size_t i = 0; i < out.size(); ++i) {
            const double root = static_cast<double>(i) / kSteps;
            out[i] = static_cast<std::uint8_t>(std::lround(255 * to_srgb(root * root)));
        }
        return out;
    }();
    return table;
}

std::uint8_t encoded(float linear) {
    const float limited = linear > 0 ? std::min(linear, 1.0F) : 0.0F;  // NaN is not above 0
    return curve()[static_cast<std::size_t>(std::sqrt(limited) * static_cast<float>(kSteps) + 0.5F)];
}

}  // namespace

ScreenPicture screen_picture(const Image& image) {
    ScreenPicture out{image.width, image.height, {}};
    const std::size_t count = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    const auto channels = static_cast<std::size_t>(image.channels);
    out.pixels.resize(4 * count);
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t c = 0; c < 3; ++c)
            out.pixels[4 * i + c] = encoded(image.pixels[channels * i + c]);
        out.pixels[4 * i + 3] = 255;
    }
    return out;
}

ScreenPicture sharpening_picture(const Image& image, const Image& plain) {
    if (image.width != plain.width || image.height != plain.height)
        fail("sharpening: pictures of {}x{} and {}x{}, expected equal sizes", image.width, image.height, plain.width,
             plain.height);
    ScreenPicture out = screen_picture(image);
    const ScreenPicture other = screen_picture(plain);
    for (std::size_t i = 0; i < out.pixels.size(); i += 4) {
        int most = 0, sum = 0;
        for (std::size_t c = 0; c < 3; ++c) {
            most = std::max(most, std::abs(int{out.pixels[i + c]} - int{other.pixels[i + c]}));
            sum += out.pixels[i + c];
        }
        const double grey = sum / 3.0 * 0.6;
        const double strength = std::min(most / 64.0, 1.0);  // 1 at a quarter of full scale
        const double share = std::clamp((strength - 0.125) / 0.25, 0.0, 0.85);
        const std::array<double, 3> heat{255 * std::clamp(2 * strength, 0.0, 1.0),
                                         255 * std::clamp(2 - 2 * strength, 0.0, 1.0) * std::min(1.0, 2 * strength),
                                         255 * std::clamp(1 - 2 * strength, 0.0, 1.0)};
        for (std::size_t c = 0; c < 3; ++c)
            out.pixels[i + c] = static_cast<std::uint8_t>(std::lround(grey * (1 - share) + heat[c] * share));
    }
    return out;
}

double rms_after_upscaling(const Image& small, const Image& large) {
    const ScreenPicture from = screen_picture(small), to = screen_picture(large);
    double sum = 0;
    const auto row = [&](const ScreenPicture& picture, int x, int y, std::size_t c) {
        const auto at =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) + static_cast<std::size_t>(x);
        return double{static_cast<double>(picture.pixels[4 * at + c])};
    };
    for (int y = 0; y < to.height; ++y) {
        const double v = std::clamp((y + 0.5) * from.height / to.height - 0.5, 0.0, from.height - 1.0);
        const int v0 = static_cast<int>(v), v1 = std::min(v0 + 1, from.height - 1);
        for (int x = 0; x < to.width; ++x) {
            const double u = std::clamp((x + 0.5) * from.width / to.width - 0.5, 0.0, from.width - 1.0);
            const int u0 = static_cast<int>(u), u1 = std::min(u0 + 1, from.width - 1);
            for (std::size_t c = 0; c < 3; ++c) {
                const double value = std::lerp(std::lerp(row(from, u0, v0, c), row(from, u1, v0, c), u - u0),
                                               std::lerp(row(from, u0, v1, c), row(from, u1, v1, c), u - u0), v - v0);
                const double difference = (value - row(to, x, y, c)) / 255;
                sum += difference * difference;
            }
        }
    }
    return std::sqrt(sum / (3.0 * to.width * to.height));
}

}  // namespace edgesplat::viewer

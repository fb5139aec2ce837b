#include "engine/reference/7_resolve.h"

#include <algorithm>

namespace edgesplat::reference {

namespace {

template <typename Pixel>
Image resolved(std::span<const glm::dvec4> frame, int width, int height, int channels, const Pixel& pixel) {
    Image image(width, height, channels);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const glm::dvec4 v = pixel(
                frame[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)], y);
            for (int c = 0; c < channels; ++c)
                image.at(x, y, c) = static_cast<float>(v[c]);
        }
    }
    return image;
}

}  // namespace

Image resolve_color(std::span<const glm::dvec4> frame, int width, int height, const glm::dvec3& background,
                    const std::optional<glm::dvec3>& top) {
    return resolved(frame, width, height, 4, [&](const glm::dvec4& v, int y) {
        const double up = static_cast<double>(height - 1 - y) / std::max(height - 1, 1);
        const glm::dvec3 behind = top ? glm::mix(background, *top, up) : background;
        return glm::dvec4(glm::dvec3(v) + (1 - v.w) * behind, v.w);
    });
}

Image resolve_mean(std::span<const glm::dvec4> frame, int width, int height) {
    return resolved(frame, width, height, 1,
                    [](const glm::dvec4& v, int) { return glm::dvec4(v.w > 0 ? v.x / v.w : 0.0); });
}

Image resolve_normal(std::span<const glm::dvec4> frame, int width, int height) {
    return resolved(frame, width, height, 3, [](const glm::dvec4& v, int) {
        const double length = glm::length(glm::dvec3(v));
        return length > 0 ? v / length : glm::dvec4(0);
    });
}

Image resolve_sum(std::span<const glm::dvec4> frame, int width, int height) {
    return resolved(frame, width, height, 1, [](const glm::dvec4& v, int) { return glm::dvec4(v.w); });
}

}  // namespace edgesplat::reference

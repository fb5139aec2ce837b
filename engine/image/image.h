// An image in memory.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace edgesplat {

/// Float pixels, rows from the top, channels interleaved, linear light, colour premultiplied by alpha.
struct Image {
    int width = 0;
    int height = 0;
    int channels = 0;
    std::vector<float> pixels;  ///< (height, width, channels)

    Image() = default;
    Image(int w, int h, int c)
        : width(w),
          height(h),
          channels(c),
          pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) * static_cast<std::size_t>(c), 0.0F) {}
    float& at(int x, int y, int c) { return pixels[offset(x, y, c)]; }
    float at(int x, int y, int c) const { return pixels[offset(x, y, c)]; }

  private:
    std::size_t offset(int x, int y, int c) const {
        return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) *
                   static_cast<std::size_t>(channels) +
               static_cast<std::size_t>(c);
    }
};

}  // namespace edgesplat

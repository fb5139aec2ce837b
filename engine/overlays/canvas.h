// A transparent sheet to draw signs on, laid over a picture with a dark rim so that they can be read over anything.
#pragma once

#include <glm/glm.hpp>
#include <string_view>
#include <vector>

#include "engine/image/image.h"

namespace edgesplat {

/// Pixels x0 <= x < x1, y0 <= y < y1.
struct PixelBox {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    bool contains(int x, int y) const { return x >= x0 && x < x1 && y >= y0 && y < y1; }
};

/// Positions are in pixels of the picture, (0, 0) at the upper left corner of the first one; colours in linear light.
class Canvas {
  public:
    /// `rim` pixels around everything drawn are darkened; `box` has room for it.
    Canvas(const PixelBox& box, int rim);

    /// A line with round ends, antialiased by its distance to the pixels' centres.
    void line(const glm::dvec2& from, const glm::dvec2& to, double width, const glm::dvec3& color);
    /// A rectangle between two corners; partly covered pixels take their share.
    void rectangle(const glm::dvec2& low, const glm::dvec2& high, const glm::dvec3& color);
    /// A line of text, its box (text_size) centred at `center`. Throws Error when the font is missing.
    void text(std::string_view text, const glm::dvec2& center, int height, const glm::dvec3& color);

    /// Blends everything into an RGB or RGBA picture; outside the box nothing changes.
    void lay_over(Image& image) const;

    const PixelBox& box() const { return box_; }

  private:
    void cover(int x, int y, double share, const glm::dvec3& color);

    PixelBox box_;
    int rim_, width_, height_;
    std::vector<glm::vec4> pixels_;  ///< (height, width), premultiplied
};

/// Width and height of a line of text in pixels, for letters of this height.
glm::ivec2 text_size(std::string_view text, int height);

}  // namespace edgesplat

// A transparent canvas for overlays, blended over a picture with a dark rim for contrast.
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

/// Positions are in pixels of the picture; (0, 0) is the upper left corner of the first pixel. Colours are in linear
/// light.
class Canvas {
  public:
    /// Darkens `rim` pixels around everything drawn; `box` must include them.
    Canvas(const PixelBox& box, int rim);

    /// Draws a line with round ends, antialiased by the distance to the pixel centres.
    void line(const glm::dvec2& from, const glm::dvec2& to, double width, const glm::dvec3& color);
    /// Draws a rectangle; partly covered pixels are blended by coverage.
    void rectangle(const glm::dvec2& low, const glm::dvec2& high, const glm::dvec3& color);
    /// Draws a line of text with its box (text_size) centred at `center`. Throws Error if the font is missing.
    void text(std::string_view text, const glm::dvec2& center, int height, const glm::dvec3& color);

    /// Blends the canvas into an RGB or RGBA picture; pixels outside the box do not change.
    void blend_into(Image& image) const;

    const PixelBox& box() const { return box_; }

  private:
    void cover(int x, int y, double share, const glm::dvec3& color);

    PixelBox box_;
    int rim_, width_, height_;
    std::vector<glm::vec4> pixels_;  ///< (height, width), premultiplied
};

/// Width and height of a line of text in pixels, for this letter height.
glm::ivec2 text_size(std::string_view text, int height);

}  // namespace edgesplat

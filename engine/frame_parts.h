// A picture whose sheets are drawn in parts: which sheets are whose, and how a part that has something in front of it
// closes its pixels where the whole picture would.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "engine/renderer_parts.h"

namespace edgesplat {

/// The part's sheets, half open: consecutive, with about as many of all `pairs` (per sheet) as any other part's.
/// Together the parts are all sheets; where there are fewer sheets than parts, some have none.
glm::uvec2 sheets_of_part(std::span<const std::uint32_t> pairs, const SheetPart& part);

/// What is in front of a part decides over its pixels: behind closed ones nothing is added, and those that close within
/// the part must be drawn anew, so that they take nothing after the sheet that closes them.
class PixelsBehind {
  public:
    /// `in_front`: what the parts in front let through. `part`: this part as it was drawn with nothing in front; where
    /// the parts in front are closed it becomes empty. `pixels` is what it is to be drawn over again: closed but for
    /// those that must be.
    PixelsBehind(std::span<const float> in_front, float saturation, std::span<glm::vec4> part,
                 std::span<glm::vec4> pixels);

    bool any() const { return !again_.empty(); }
    /// Of each tile, how many pixels of `size` are closed; row by row.
    std::vector<std::uint32_t> closed_pixels(const glm::ivec2& size, const glm::ivec2& tiles) const;
    /// Takes what was drawn again over into the part, as if nothing were in front.
    void take(std::span<const float> in_front, std::span<const glm::vec4> pixels, std::span<glm::vec4> part) const;

  private:
    std::vector<std::size_t> again_;
};

}  // namespace edgesplat

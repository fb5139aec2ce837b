// Pass 6: composites one sheet behind the frame so far (docs/method/6_composite_7_resolve.md).
#pragma once

#include <glm/glm.hpp>
#include <span>

namespace edgesplat::reference {

/// `frame` and `sheet` have one entry per pixel. frame: premultiplied quantity (3) and opacity A; sheet: sum of tau *
/// quantity (3) and sum of tau. Saturated pixels, whose `closed` is not 0, are skipped; an empty `closed` skips none.
void composite_sheet(std::span<glm::dvec4> frame, std::span<const glm::dvec4> sheet, std::span<const char> closed = {});

}  // namespace edgesplat::reference

// Pass 6: one sheet behind what is already there (method.md, 6_composite_sheet).
#pragma once

#include <glm/glm.hpp>
#include <span>

namespace edgesplat::reference {

/// `frame` and `sheet` have one entry per pixel. frame: premultiplied quantity (3) and opacity A; sheet: sum of
/// tau * quantity (3) and sum of tau. `closed` pixels (non-zero) take nothing; empty: all are open.
void composite_sheet(std::span<glm::dvec4> frame, std::span<const glm::dvec4> sheet, std::span<const char> closed = {});

}  // namespace edgesplat::reference

// Pass 7: resolves accumulated frames into pictures (docs/method/6_composite_7_resolve.md).
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>

#include "engine/image/image.h"

namespace edgesplat::reference {

/// RGBA over the background; alpha is the volume's own opacity. With `top` the background is a gradient from
/// `background` (bottom row) to `top` (top row).
Image resolve_color(std::span<const glm::dvec4> frame, int width, int height, const glm::dvec3& background,
                    const std::optional<glm::dvec3>& top = {});

/// Opacity-weighted mean of the first component, 1 channel; 0 in empty pixels.
Image resolve_mean(std::span<const glm::dvec4> frame, int width, int height);

/// Normalised mean direction, 3 channels; 0 in empty pixels.
Image resolve_normal(std::span<const glm::dvec4> frame, int width, int height);

/// The fourth component, 1 channel: tau if sheets were only added up.
Image resolve_sum(std::span<const glm::dvec4> frame, int width, int height);

}  // namespace edgesplat::reference

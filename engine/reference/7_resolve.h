// Pass 7: from accumulated frames to pictures (method.md, 7_resolve).
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>

#include "engine/image/image.h"

namespace edgesplat::reference {

/// RGBA, background blended in; alpha is the volume's own opacity. With `top` the background goes from `background` in
/// the bottom row to it in the top row.
Image resolve_color(std::span<const glm::dvec4> frame, int width, int height, const glm::dvec3& background,
                    const std::optional<glm::dvec3>& top = {});

/// Opacity-weighted mean of the first component, 1 channel; 0 where nothing was hit.
Image resolve_mean(std::span<const glm::dvec4> frame, int width, int height);

/// Normalised mean direction, 3 channels; 0 where nothing was hit.
Image resolve_normal(std::span<const glm::dvec4> frame, int width, int height);

/// The fourth component as it is, 1 channel: tau where sheets were simply added up.
Image resolve_sum(std::span<const glm::dvec4> frame, int width, int height);

}  // namespace edgesplat::reference

// The difference of two pictures as colours, on a logarithmic scale that is the same throughout a report.
#pragma once

#include <glm/glm.hpp>
#include <string>

#include "engine/image/image.h"

namespace edgesplat::accuracy {

inline constexpr double kHeatLow = 1e-4, kHeatHigh = 1;  ///< difference at the scale's ends, of full scale

/// Colour of a share 0..1 of the scale: dark blue, through green, to yellow; sRGB 0..1. Lightness rises throughout.
glm::dvec3 heat_color(double share);

/// Largest difference of each pixel's colour channels as a colour. Three channels, linear light. Throws Error if sizes
/// differ.
Image heat_map(const Image& a, const Image& b);

/// The scale as CSS: "linear-gradient(90deg, ...)".
std::string heat_gradient();

}  // namespace edgesplat::accuracy

// Computes a picture row by row on every core; a progress function can cancel it.
#pragma once

#include <functional>
#include <vector>

#include "engine/error.h"
#include "engine/reference/ray_quadrature.h"

namespace edgesplat::reference {

/// Thrown if the progress function returns false.
class Cancelled : public Error {
  public:
    using Error::Error;
};

/// Called with the share done, 0..1; returning false cancels.
using Progress = std::function<bool(double done)>;

/// Throws Error unless both are 1 to 16384 pixels.
void check_picture_size(int width, int height);

/// The results of a picture's rays.
struct RayFrame {
    std::vector<glm::dvec4> pixels;  ///< (height, width): premultiplied colour and opacity, or 0 and tau
    double error = 0;                ///< largest error of any ray
    std::uint64_t samples = 0;       ///< sum over all rays
};

enum class RayValue { Opacity, Tau };  ///< content of the fourth component
using RayTracer = std::function<RaySum(int x, int y)>;

/// Traces one ray per pixel, rows in parallel, in an order that mixes cheap and expensive rows. `make` makes a tracer
/// for each row. `progress` may be empty; it is called only from the calling thread, at the end with 1. Throws
/// Cancelled, or what a tracer throws.
RayFrame trace_rays(int width, int height, RayValue value, const Progress& progress,
                    const std::function<RayTracer()>& make);

}  // namespace edgesplat::reference

// A picture computed row by row on every core, with a report of progress that can stop it.
#pragma once

#include <functional>
#include <vector>

#include "engine/error.h"
#include "engine/reference/ray_quadrature.h"

namespace edgesplat::reference {

/// Thrown where the progress function said no.
class Cancelled : public Error {
  public:
    using Error::Error;
};

/// Given the share done, 0..1; false stops.
using Progress = std::function<bool(double done)>;

/// Throws Error unless both are 1 to 16384 pixels.
void check_picture_size(int width, int height);

/// What the rays of a picture brought.
struct RayFrame {
    std::vector<glm::dvec4> pixels;  ///< (height, width): premultiplied colour and opacity, or 0 and tau
    double error = 0;                ///< largest of any ray
    std::uint64_t samples = 0;       ///< of all rays
};

enum class RayValue { Opacity, Tau };  ///< what goes into the fourth component
using RayTracer = std::function<RaySum(int x, int y)>;

/// One ray per pixel, rows in parallel and in an order in which cheap and dear ones mix; `make` gives each row a tracer
/// of its own. `progress` may be empty; it is called from the calling thread only, at the end with 1. Throws Cancelled,
/// or what a tracer threw.
RayFrame trace_rays(int width, int height, RayValue value, const Progress& progress,
                    const std::function<RayTracer()>& make);

}  // namespace edgesplat::reference

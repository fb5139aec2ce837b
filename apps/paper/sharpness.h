// How sharp a picture is, measured without knowing what it should show.
#pragma once

#include "engine/image/image.h"

namespace edgesplat {

struct Sharpness {
    double gradient_energy = 0;  ///< sum of squared differences of neighbouring pixels' luminance
    double edge_width = 0;       ///< pixels from 10 to 90 % across an edge, median of the picture's steepest
    int edges = 0;               ///< how many that is the median of
};

/// Edges: where luminance is steeper than in 95 % of the picture and than to either side. An edge ends where luminance
/// turns or hardly changes any more.
Sharpness sharpness(const Image& color);

}  // namespace edgesplat

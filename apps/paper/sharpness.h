// Measures the sharpness of a picture without a reference picture.
#pragma once

#include "engine/image/image.h"

namespace edgesplat {

struct Sharpness {
    double gradient_energy = 0;  ///< sum of squared differences of neighbouring pixels' luminance
    double edge_width = 0;       ///< pixels from 10 to 90 % across an edge, median of the picture's steepest
    int edges = 0;               ///< number of edges in that median
};

/// Edges: pixels where luminance is steeper than in 95 % of the picture and steeper than on either side. An edge ends
/// where luminance turns, or where its slope is below 5 % of the pixel's.
Sharpness sharpness(const Image& color);

}  // namespace edgesplat

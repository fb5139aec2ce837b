// Pass 5, refined pixels: selects the pixels to draw and interpolates the others.
#pragma once

#include <cstddef>

#include "engine/image/image.h"

namespace edgesplat::reference {

struct RefinedPicture {
    Image picture;          ///< premultiplied colour and opacity, drawn or interpolated
    std::size_t drawn = 0;  ///< number of pixels drawn
};

/// `every`: (height, width, 4) premultiplied colour and opacity, with all pixels drawn. All voxels must be wider than
/// REFINE_STEP pixels. docs/method/tiles.md, 5_refine_pixels.
RefinedPicture refine_pixels(const Image& every);

}  // namespace edgesplat::reference

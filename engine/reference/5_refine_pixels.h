// Pass 5, refined pixels: which pixels of a picture are drawn, and what the others become.
#pragma once

#include <cstddef>

#include "engine/image/image.h"

namespace edgesplat::reference {

struct RefinedPicture {
    Image picture;          ///< premultiplied colour and opacity, as it would be if `drawn` pixels alone were known
    std::size_t drawn = 0;  ///< pixels that had to be
};

/// `every`: (height, width, 4) premultiplied colour and opacity, all pixels drawn, of splats whose voxels are all wider
/// than REFINE_STEP pixels. docs/method.md, 5_refine_pixels.
RefinedPicture refine_pixels(const Image& every);

}  // namespace edgesplat::reference

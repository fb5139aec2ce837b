// The three slices as pictures on the canvas.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <memory>
#include <optional>

#include "apps/edgesplat-fly/canvas.h"
#include "engine/viewer/slices.h"

/// How slices are displayed.
struct SliceView {
    std::shared_ptr<const edgesplat::Volume> volume;  ///< whose slices are shown
    double low = 0, high = 1;                         ///< values shown as black and white
};

/// A slice, and the values for which it was made.
struct SlicePicture {
    CanvasPicture picture;
    std::optional<edgesplat::viewer::Slice> slice;
    const edgesplat::Volume* volume = nullptr;
    int depth = -1;
    double low = 0, high = 0;
};

using SlicePictures = std::array<SlicePicture, 3>;

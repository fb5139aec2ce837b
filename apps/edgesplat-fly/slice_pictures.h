// The three slices as they are on the canvas.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <memory>
#include <optional>

#include "apps/edgesplat-fly/canvas.h"
#include "engine/viewer/slices.h"

/// How slices are looked at.
struct SliceView {
    std::shared_ptr<const edgesplat::Volume> volume;  ///< that the window is of
    double low = 0, high = 1;                         ///< values shown as black and white
};

/// A slice, and what it was made for.
struct SlicePicture {
    CanvasPicture picture;
    std::optional<edgesplat::viewer::Slice> slice;
    const edgesplat::Volume* volume = nullptr;
    int depth = -1;
    double low = 0, high = 0;
};

using SlicePictures = std::array<SlicePicture, 3>;

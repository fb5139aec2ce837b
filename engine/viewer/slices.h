// Orthogonal slices through a volume, as grey pictures.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "engine/volume/volume.h"

namespace edgesplat::viewer {

/// Row 0 is the top. A slice is oriented as radiologists view patients in LPS: world +x and +y go right; vertically, +z
/// goes up and +y down. Each volume axis is oriented by the nearest world axis.
struct Slice {
    int axis = 2;                    ///< of the volume's index space, perpendicular to the slice
    int width = 0, height = 0;       ///< pixels
    std::vector<std::uint8_t> grey;  ///< (height, width): 0 at `low` and below, 255 at `high` and above
    glm::dvec2 pixel_mm{1};          ///< size of a pixel
    glm::dvec2 cross{0};             ///< the point's place: pixels from the top left corner, centres at .5
    // For the inverse mapping.
    glm::ivec2 across{0, 1};  ///< axes of index space along rows and down columns
    glm::bvec2 turned{false};
    double depth = 0;   ///< voxel along `axis`
    double voxels = 1;  ///< of the volume per pixel; more than 1 if a packed volume is shown coarsely
};

/// The slice nearest to `voxel` (index space; clamped to the volume), perpendicular to an axis 0..2. A packed volume is
/// read at the finest level at which the slice has at most 1024 pixels a side. Throws Error: another axis, values that
/// are not finite, low >= high, an unreadable packed file.
Slice slice(const Volume& volume, int axis, const glm::dvec3& voxel, double low, double high);

/// The place in index space of a point of the slice (in pixels, like `cross`), also beyond its borders.
glm::dvec3 voxel_at(const Slice& slice, const glm::dvec2& pixel);

/// Patient letters (engine/scene/views.h) of the slice's left, right, upper and lower side. The volume must be of a
/// patient.
std::array<char, 4> slice_letters(const Slice& slice, const VolumeGeometry& geometry);

/// The pixel of a place in index space, projected along the slice's axis: inverse of voxel_at.
glm::dvec2 pixel_at(const Slice& slice, const glm::dvec3& voxel);

}  // namespace edgesplat::viewer

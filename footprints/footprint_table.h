// A table of footprints of kernels that plane faces cut: layers of a texture array over the face's distance D from the
// voxel and cos theta, theta the angle between its normal and the ray.
//
// A layer holds one footprint; its x axis is the projected normal. The ray at (x, y) meets the face within the kernel
// if x lies in D sin theta +- cos theta sqrt(R^2 - e^2 - y^2), e = D - depth. A row has texels for the parts before,
// across and beside that stretch, and the ends of the parts lie on texels. So a step between two texels lies where the
// face has it, also edge-on, and blending layers moves no edge. Distances and directions are spaced evenly in the
// tangent of half an angle: e = R sin, cos theta = sin. Lengths are voxels.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "footprints/kernel.h"

namespace edgesplat {

/// The layers of a splat, and the position of its face in them.
struct FootprintLayer {
    std::uint32_t code = 0;  ///< shaders/shared/footprint_table.h: the first of four layers, and how they are blended
    double middle = 0;       ///< D sin theta: x of the face's foot point
    double cosine = 0;       ///< of theta, [0, 1]
    double rim2 = 0;         ///< R^2 - e^2: squared radius of the disc in which the face cuts the kernel
};

/// The kernel of tables of that depth: the narrow one if it is `FACE_DEPTH`.
const Kernel& kernel_of_table(double depth);

/// The layers of a face at `distance` along n, for a ray with |n . u| = `cosine`; from R + depth on, the plain layer.
FootprintLayer select_footprint_layer(double distance, double cosine, double depth);

/// The layer of a kernel that no face cuts. It has no direction: x is 0.
FootprintLayer plain_footprint_layer(double depth);

/// The layers that a code selects.
FootprintLayer decode_footprint_layer(std::uint32_t code, double depth);

class FootprintTable {
  public:
    /// `depth`: as in FaceCut.
    explicit FootprintTable(double depth);

    /// Half floats [layer][y][x]; for a sampler with linear filter, clamped to the edge.
    std::span<const std::uint16_t> texels() const { return texels_; }

    /// The footprint at (x, y) from the voxel: blended between the four layers, bilinear within each.
    double lookup(const FootprintLayer& layer, double x, double y) const;

  private:
    double depth_;
    std::vector<std::uint16_t> texels_;
};

/// The table of that depth, built at its first use and kept until the program ends.
const FootprintTable& kept_footprint_table(double depth);

/// IEEE half precision of a value in [0, 65520), rounded to nearest even.
std::uint16_t half_from_float(float value);
float float_from_half(std::uint16_t half);

}  // namespace edgesplat

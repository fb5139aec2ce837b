// Footprints of kernels that plane faces cut, integrated ahead: layers of a texture array over the face's distance D
// from the voxel and cos theta, theta the angle between its normal and the ray.
//
// A layer is a picture of one footprint, the normal's projection along its x. The ray at (x, y) meets the face within
// the kernel where x is D sin theta +- cos theta sqrt(R^2 - e^2 - y^2), e = D - depth; edges of that stretch are kept
// on texels: a row has texels for what lies before it, across it and beside it, so that a step between two texels is
// where the face has it, seen edge-on, too, and blending layers moves no edge. Distances and directions are both taken
// as tangents of half an angle: e = R sin, cos theta = sin. Lengths are voxels.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "footprints/kernel.h"

namespace edgesplat {

/// Which layers a splat takes, and where its face lies in them.
struct FootprintLayer {
    std::uint32_t code = 0;  ///< shaders/shared/footprint_table.h: the first of four layers, and how they are blended
    double middle = 0;       ///< D sin theta: where on x the face's foot point is seen
    double cosine = 0;       ///< of theta, [0, 1]
    double rim2 = 0;         ///< R^2 - e^2: squared radius of what the face cuts off the kernel
};

/// What tables of that depth hold: the narrow kernel where it is `kFaceDepth`.
const Kernel& kernel_of_table(double depth);

/// Of a face at `distance` along n, seen along a direction with |n . u| = `cosine`; from R + depth on, the plain layer.
FootprintLayer select_footprint_layer(double distance, double cosine, double depth);

/// Of a kernel that no face cuts. Its layer is the same whichever way it is turned: x is 0.
FootprintLayer plain_footprint_layer(double depth);

/// What the code alone says.
FootprintLayer decode_footprint_layer(std::uint32_t code, double depth);

class FootprintTable {
  public:
    /// `depth`: where kernels are sampled at least, as in FaceCut.
    explicit FootprintTable(double depth);

    /// Half floats [layer][y][x]; for a sampler with linear filter, clamped to the edge.
    std::span<const std::uint16_t> texels() const { return texels_; }

    /// The footprint at (x, y) from the voxel: blended between the four layers, bilinear within each.
    double lookup(const FootprintLayer& layer, double x, double y) const;

  private:
    double depth_;
    std::vector<std::uint16_t> texels_;
};

/// The same for as long as the program runs: built when it is first asked for.
const FootprintTable& kept_footprint_table(double depth);

/// IEEE half precision of what is at least 0 and below 65520, round to nearest even.
std::uint16_t half_from_float(float value);
float float_from_half(std::uint16_t half);

}  // namespace edgesplat

// Where a ray falls in a footprint table: shared by building and look-up, mirrored by shaders/lib/footprint.glsl.
#pragma once

#include "footprints/footprint_integral.h"

namespace edgesplat {

/// A ray and a signed edge distance in table coordinates.
struct TablePoint {
    double distance;   ///< d >= 0: the mirror image serves d < 0
    double direction;  ///< layer coordinate of |cos theta|, [0, 1]
    double sine;       ///< sin theta
    double X;          ///< base coordinate along the projected normal, voxels
    double y;          ///< across it, voxels
    double base_r2;    ///< X^2 + y^2: the base footprint is g of it
};

TablePoint table_point(const Ray& ray, double distance, const EdgeBand& band);

/// |cos theta| of a layer coordinate in [0, 1] and back: even steps in the angle, denser towards edge-on.
double table_direction(double coordinate);
double table_direction_coordinate(double c);

/// The mean slope of M that a ray at |cos theta| = c sees across the edge: the base warp's strength.
double table_base_strength(double c, const EdgeBand& band);

/// The x with base coordinate X in the layer (d, c).
double table_x_of(double X, double d, double c, const EdgeBand& band);

/// |X| of any point where a footprint of this band is not zero.
double table_extent(const EdgeBand& band);

}  // namespace edgesplat

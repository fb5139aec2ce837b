// Where outlines pass pixels, and what such pixels show (method.md, 5_draw_tiles and 7_resolve, "Outlines").
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "engine/reference/3_select_footprints.h"

namespace edgesplat::reference {

/// An outline that passes less than a pixel from a pixel's centre.
struct Outline {
    double level = 0;   ///< how far outside of it the centre is along the axis, pixels; negative: inside
    double offset = 0;  ///< of the outline from the centre along the axis, pixels, (-1, 1)
    bool down = false;  ///< the axis: downwards, or to the right
};

/// The outline of a splat's face or crease beside the ray p + z u, which passes its kernel. p: the ray's point nearest
/// to the voxel, relative to it, u: unit, index space; `ahead`: from the eye to p; `tau`: what the splat shows of the
/// ray; `kernel`: the splat's.
std::optional<Outline> outline_of(const VoxelEdge& edge, const View& view, const glm::dvec3& p, const glm::dvec3& u,
                                  double ahead, double tau, const Kernel& kernel);

/// Of two splats' outlines: matter of either is matter of both.
void keep_outer(std::optional<Outline>& kept, const std::optional<Outline>& found);

/// The picture with what each pixel that an outline passes shows of its neighbour there. One entry per pixel.
std::vector<glm::dvec4> smoothed(std::span<const glm::dvec4> frame, std::span<const std::optional<Outline>> outlines,
                                 int width, int height);

}  // namespace edgesplat::reference

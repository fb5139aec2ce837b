// Finds the outlines that pass through pixels, and blends the neighbours of those pixels (docs/method/smoothing.md,
// Outlines).
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "engine/reference/3_select_footprints.h"

namespace edgesplat::reference {

/// An outline that passes less than a pixel from a pixel's centre.
struct Outline {
    double level = 0;   ///< distance of the centre outside it along the axis, pixels; negative: inside
    double offset = 0;  ///< from the centre to the outline along the axis, pixels, (-1, 1)
    bool down = false;  ///< axis: true downwards, false to the right
};

/// The outline of a splat's face or crease next to the ray p + z u. p: the ray's point nearest to the voxel, relative
/// to it; u: unit, index space; `ahead`: from the eye to p, voxels; `tau`: the splat's optical depth on the ray.
std::optional<Outline> outline_of(const VoxelEdge& edge, const View& view, const glm::dvec3& p, const glm::dvec3& u,
                                  double ahead, double tau);

/// The outline next to a point of the ray along u, `way` voxels from the eye, where a function with this gradient
/// (index space) is `level`; matter lies where it is negative. nullopt if the outline is a pixel or more away.
std::optional<Outline> outline_at(const View& view, const glm::dvec3& u, double way, double level,
                                  const glm::dvec3& gradient);

/// Keeps the outer of two splats' outlines, since the matter of either counts.
void keep_outer(std::optional<Outline>& kept, const std::optional<Outline>& found);

/// The picture after each pixel with an outline is blended with its neighbour beyond that outline. One entry per pixel.
std::vector<glm::dvec4> smoothed(std::span<const glm::dvec4> frame, std::span<const std::optional<Outline>> outlines,
                                 int width, int height);

}  // namespace edgesplat::reference

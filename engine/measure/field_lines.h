// The field along a line parallel to a volume axis: a polynomial between neighbouring samples.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "engine/reference/field.h"

namespace edgesplat::measure {

/// Positions are in index space, voxels. The line extends half a voxel beyond the outermost samples; there the field
/// has the value of the nearest position between the samples.
class FieldLine {
  public:
    /// Uses the field's spline if it has coefficients, else linear interpolation of its samples.
    FieldLine(const reference::Field& field, int axis);

    /// Moves to the line along the axis through `across`; its coordinate along the axis is ignored.
    void move_to(const glm::dvec3& across);

    int axis() const { return axis_; }
    glm::dvec3 at(double t) const;
    bool follows_spline() const { return cubic_; }
    glm::dvec3 slope(double t) const;  ///< gradient of the spline, per voxel along each axis

    /// Whether the value at the line's beginning is >= `iso`.
    bool starts_from(double iso) const { return value_at_first() >= iso; }
    /// Calls `crossing` with each position where the field crosses `iso` in either direction, ascending.
    void for_crossings(double iso, const std::function<void(double)>& crossing) const;

  private:
    double value_at_first() const;

    const reference::Field& field_;
    int axis_;
    bool cubic_;
    glm::dvec3 across_{0};
    std::vector<double> nodes_;  ///< spline coefficients along the line plus one beyond either end, or samples
};

}  // namespace edgesplat::measure

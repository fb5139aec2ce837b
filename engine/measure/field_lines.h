// A line along an axis of the volume: the field on it is a polynomial from sample to sample.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "engine/reference/field.h"

namespace edgesplat::measure {

/// Positions are in index space, voxels; the line reaches half a voxel beyond the outermost samples, and the field
/// there is that of the nearest place between them.
class FieldLine {
  public:
    /// Through the field's spline if it has coefficients, else between its samples.
    FieldLine(const reference::Field& field, int axis);

    /// To the line along the axis through `across`, of which the axis' own coordinate does not matter.
    void move_to(const glm::dvec3& across);

    int axis() const { return axis_; }
    glm::dvec3 at(double t) const;
    bool follows_spline() const { return cubic_; }
    glm::dvec3 slope(double t) const;  ///< of the spline, per voxel along each axis

    /// Whether it begins at values from `iso` up.
    bool starts_from(double iso) const { return value_at_first() >= iso; }
    /// Where the values change from below `iso` to `iso` or above, or back, in ascending order.
    void for_crossings(double iso, const std::function<void(double)>& crossing) const;

  private:
    double value_at_first() const;

    const reference::Field& field_;
    int axis_;
    bool cubic_;
    glm::dvec3 across_{0};
    std::vector<double> nodes_;  ///< the spline's coefficients along the line and one beyond either end, or values
};

}  // namespace edgesplat::measure

// The field that the ray caster takes for the samples, as a scene: truth() of it is the ray caster's picture in double
// precision, without steps (method.md, Ray caster).
#pragma once

#include "engine/scene/renderer_kind.h"
#include "engine/volume/analytic_volumes.h"

namespace edgesplat::reference {

/// Value and gradient in the volume's unit, on its grid; no distance. Gradients are those of points at least one voxel
/// inside the border: of interpolated values the interpolated central differences, of the spline its slope.
AnalyticScene interpolated_scene(const Volume& volume, RaycastFilter filter);

}  // namespace edgesplat::reference

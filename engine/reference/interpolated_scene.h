// The field that the ray caster interpolates from the samples, as an analytic scene. truth() of it is the ray caster's
// picture in double precision, without steps (docs/method/raycast.md).
#pragma once

#include "engine/scene/renderer_kind.h"
#include "engine/scene/scene.h"
#include "engine/volume/analytic_volumes.h"

namespace edgesplat::reference {

/// Value and gradient in the volume's unit, on its grid; no distance. Gradients are taken at least one voxel inside the
/// border: interpolated central differences, or with the cubic filter the spline's gradient. Where samples contain no
/// data, matter that `look` would draw is missing; with a transfer function, values are interpolated from the others.
AnalyticScene interpolated_scene(const Volume& volume, RaycastFilter filter, const Scene& look);

}  // namespace edgesplat::reference

// Volume -> edge field: distance and direction of the nearest edge of every voxel that can be seen.
#pragma once

#include "engine/gpu/commands.h"
#include "engine/passes/clip_count.h"
#include "engine/scene/settings.h"

namespace edgesplat::passes {

/// Marks voxels that opaque ones hide from every side (three line sweeps). What `clip` cuts away is not opaque.
void mark_buried(gpu::Commands& commands, const glm::ivec3& dims, const ClipCount& clip = {});

/// Specialization of 1b_estimate_edges.comp.
gpu::Specialization estimate_constants(EdgeEstimator estimator, bool skip_buried);

/// Reads the volume (and, for `cubic`, its coefficients) and SceneParams at `scene`; writes the edge field, one texel
/// per voxel. With `skip_buried`, voxels marked by
/// mark_buried get none. View-independent. With EdgeEstimator::Off only normals for light are written.
void estimate_edges(gpu::Commands& commands, const glm::ivec3& dims, EdgeEstimator estimator, bool skip_buried);

}  // namespace edgesplat::passes

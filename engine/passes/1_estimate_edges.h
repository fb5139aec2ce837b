// Volume -> edge field: distance and direction of the nearest edge of every voxel that can be seen.
#pragma once

#include "engine/gpu/commands.h"
#include "engine/scene/settings.h"

namespace edgesplat::passes {

/// Reads the volume (and, for `cubic`, its coefficients) and SceneParams at `scene`; writes the edge field, one texel
/// per voxel. View-independent. With EdgeEstimator::Off only normals for light are written.
void estimate_edges(gpu::Commands& commands, shader::Address scene, const glm::ivec3& dims, EdgeEstimator estimator);

}  // namespace edgesplat::passes

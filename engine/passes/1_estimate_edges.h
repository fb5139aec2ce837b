// Volume -> edge field: distance and direction of the nearest edge of every voxel that can be seen.
#pragma once

#include "engine/gpu/commands.h"
#include "engine/passes/clip_count.h"
#include "engine/scene/settings.h"

namespace edgesplat::passes {

/// Marks voxels that opaque ones hide from every side (three line sweeps). What `clip` cuts away is not opaque.
void mark_buried(gpu::Commands& commands, const glm::ivec3& dims, const ClipCount& clip = {});

/// The voxels of an image whose edges are wanted, along each axis.
struct EdgeRegion {
    glm::ivec3 dims{0};                    ///< of the image
    glm::ivec3 core_low{0}, core_size{0};  ///< as in SceneParams; the whole image where there is no border
};

/// Specialization of 1b_estimate_edges.comp.
gpu::Specialization estimate_constants(EdgeEstimator estimator, bool skip_buried);

/// Reads the volume (and, for `cubic`, its coefficients) and SceneParams at `scene`; writes the edge field, one texel
/// per voxel of the core and as far around it as its splats depend on. With `skip_buried`, voxels marked by mark_buried
/// get none. With EdgeEstimator::Off only normals for light are written.
void estimate_edges(gpu::Commands& commands, const EdgeRegion& region, EdgeEstimator estimator, bool skip_buried);

}  // namespace edgesplat::passes

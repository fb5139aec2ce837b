// Volume -> edge field: distance and direction of the nearest edge of every visible voxel.
#pragma once

#include "engine/gpu/commands.h"
#include "engine/passes/clip_count.h"
#include "engine/scene/settings.h"

namespace edgesplat::passes {

/// Marks voxels that opaque voxels occlude from every side (three line sweeps). Clipped voxels are not opaque.
gpu::Pass mark_buried(const glm::ivec3& dims, std::uint32_t iso_count, const ClipCount& clip);
/// The part of an image whose edges are estimated, voxels.
struct EdgeRegion {
    glm::ivec3 dims{0};                    ///< size of the image
    glm::ivec3 core_low{0}, core_size{0};  ///< as in SceneParams; the whole image if it has no border
    std::uint32_t bricks = 0;              ///< SceneParams::brick_count
};

struct EstimateEdges {
    EdgeEstimator estimator = EdgeEstimator::Cubic;
    bool skip_buried = true;  ///< voxels marked by mark_buried get no edge
    bool surfaces = false;    ///< for surface splats: voxels without an edge need no normal
    std::uint32_t iso_count = 1;
};

/// Reads the volume (and, for `cubic`, its coefficients) and SceneParams at `scene`; writes the edge field, one texel
/// per voxel of the core and of ESTIMATE_MARGIN voxels around it. With EdgeEstimator::Off it writes only normals, for
/// lighting.
gpu::Pass estimate_edges(const EdgeRegion& region, const EstimateEdges& in);

}  // namespace edgesplat::passes

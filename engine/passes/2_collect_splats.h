// Edge field -> compact list of visible voxels as splats.
#pragma once

#include "engine/gpu/commands.h"
#include "engine/passes/clip_count.h"
#include "engine/scene/settings.h"

namespace edgesplat::passes {

struct CollectSplats {
    glm::ivec3 core_size;      ///< voxels that become splats, along each axis
    std::uint32_t bricks = 0;  ///< SceneParams::brick_count
    std::uint32_t iso_count = 1;
    bool edges = true;                               ///< the edge field exists
    bool buried = true;                              ///< the buried mask exists: `mark_buried` has run
    EdgeEstimator estimator = EdgeEstimator::Cubic;  ///< selects the field that gradients are taken from
    bool faces = false;                              ///< faces are fitted to the surface around each splat
    bool surfaces = false;     ///< surface splats: only voxels beside a surface, with verified faces
    bool two_values = false;   ///< with faces: the samples have only two values
    ClipCount clip{};          ///< voxels whose kernels are clipped completely are culled
    bool transfer = false;     ///< splats are classified by a transfer function
    std::uint32_t labels = 0;  ///< SPEC_LABELS: splats get the label of their voxel
};

/// Number of runs: invocations of the counting and the writing dispatch, one per slice of a brick
/// (engine/culling/brick_runs.h).
std::uint64_t collect_runs(const glm::ivec3& core_size);

/// Writes the number of splats of each run to SceneParams::run_offsets; nothing for runs of bricks that are not listed.
gpu::Pass count_splats(const CollectSplats& in);

/// Writes the records, brick by brick. Precondition: run_offsets is an exclusive prefix sum.
gpu::Pass write_splats(const CollectSplats& in);

/// With an edge field: gives the SceneParams::list_count splats from list_first on their edges or faces.
gpu::Pass finish_splats(const CollectSplats& in, std::uint64_t count);

}  // namespace edgesplat::passes

// Edge field -> compact list of the voxels that can be seen.
#pragma once

#include "engine/gpu/commands.h"
#include "engine/passes/clip_count.h"
#include "engine/scene/settings.h"

namespace edgesplat::passes {

struct CollectSplats {
    glm::ivec3 core_size;  ///< voxels that become splats, along each axis
    std::uint32_t iso_count = 1;
    bool edges = true;                               ///< the edge field exists
    bool buried = true;                              ///< the buried mask exists: `mark_buried` has run
    EdgeEstimator estimator = EdgeEstimator::Cubic;  ///< whose field has the gradients
    bool faces = false;                              ///< splats get the faces that fit the surface around them
    ClipCount clip{};                                ///< voxels whose kernels are cut away whole are dropped
    bool transfer = false;                           ///< splats are classified by a transfer function
};

/// Specialization of 2_collect_splats.comp and of 2a_finish_splats.comp.
gpu::Specialization collect_constants(const CollectSplats& in);
gpu::Specialization finish_constants(const CollectSplats& in);

/// Invocations of the counting and of the writing dispatch, one per slice of a brick (engine/culling/brick_runs.h).
std::uint64_t collect_runs(const glm::ivec3& core_size);

/// Writes how many splats each run holds to SceneParams::run_offsets.
void count_splats(gpu::Commands& commands, const CollectSplats& in);

/// With run_offsets turned into an exclusive prefix sum: writes the records, brick by brick, and where there is an
/// edge field finishes the `count` that SceneParams says.
void write_splats(gpu::Commands& commands, const CollectSplats& in, std::uint64_t count);

}  // namespace edgesplat::passes

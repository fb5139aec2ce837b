// View-independent: passes 1 and 2, for a volume as a whole or block by block.
#pragma once

#include <optional>

#include "engine/passes/1_estimate_edges.h"
#include "engine/passes/2_collect_splats.h"
#include "engine/plan/plan.h"
#include "engine/plan/resources.h"
#include "engine/volume/changed_box.h"

namespace edgesplat {

/// Part of a volume whose splats are collected at once; voxels of the volume.
struct CollectionBlock {
    glm::ivec3 low{0}, size{0};            ///< what the device's images hold
    glm::ivec3 core_low{0}, core_size{0};  ///< what becomes splats
};
CollectionBlock whole_block(const glm::ivec3& dims);

/// What passes 1b and 1c are given, and pass 2 for the whole volume.
passes::EstimateEdges estimate_inputs(const CollectionPlan& plan);
passes::CollectSplats collect_inputs(const CollectionPlan& plan);

/// Splats that a block added to the list.
struct CollectedBlock {
    std::uint64_t first = 0, count = 0, with_edge = 0, with_crease = 0;
    glm::ivec3 low{0}, high{0};      ///< inclusive box that holds their voxels; the whole block without splats
    std::vector<SplatBrick> bricks;  ///< counted from `first`
    std::vector<PassTime> times;
};

/// Allocates what the plan's passes take for blocks as large as `largest`, drops the splats that there were, and binds
/// it all. `resources` holds the volume's image.
void prepare_collection(const gpu::Device& device, gpu::Commands& commands, Bindings& bindings,
                        const CollectionPlan& plan, const CollectionBlock& largest, VolumeResources& resources);

/// Volume -> splats, behind those in the list. The images hold the block's samples (and coefficients). With `exact` the
/// list is made as long as it has to be, else longer, for those to come. Nothing, and nothing changed, if the list
/// would be longer than `most_splats`.
std::optional<CollectedBlock> collect_block(const gpu::Device& device, gpu::Commands& commands,
                                            const CollectionPlan& plan, const CollectionBlock& block, bool exact,
                                            std::uint64_t most_splats, VolumeResources& resources);

/// Voxels whose edges renew_collection() finds.
std::uint64_t voxels_that_depend_on(const VoxelBox& changed, const glm::ivec3& dims);

/// After run_collection with the same plan, the samples in `changed` having become others: as if it were run again.
std::vector<PassTime> renew_collection(const gpu::Device& device, gpu::Commands& commands, Bindings& bindings,
                                       const CollectionPlan& plan, const VoxelBox& changed, VolumeResources& resources);

/// The whole volume at once; fills `splat_count`, the bricks and the box.
std::vector<PassTime> run_collection(const gpu::Device& device, gpu::Commands& commands, Bindings& bindings,
                                     const CollectionPlan& plan, VolumeResources& resources);

}  // namespace edgesplat

// Chooses the blocks of a volume that can have splats, and the level of detail of a picture.
#pragma once

#include "engine/store/volume_store.h"
#include "engine/volume/sample_source.h"

namespace edgesplat {

/// Voxels along a side of a block, without its border.
inline constexpr int kBlockCore = 128;

/// The largest block of a volume of that size.
CollectionBlock largest_block(const glm::ivec3& dims);

/// The blocks of a plan that can have splats, x fastest. Blocks that are transparent or buried completely, by the
/// bounds of their samples, are skipped. `volume` gives the range that samples are scaled to.
std::vector<CollectionBlock> blocks_with_splats(const SampleSource& source, const Volume& volume,
                                                const CollectionPlan& plan);

/// The finest of `levels` levels, from `finest` on, whose voxel indices fit into a splat; `levels` if there is none.
int countable_level(const VolumeGeometry& geometry, int levels, int finest);

/// The coarsest of `levels` levels whose voxels are at most `pixels` wide everywhere in the picture; 0 if level 0 is
/// wider or the volume reaches the plane of the eye.
int level_for(const VolumeGeometry& geometry, int levels, const Camera& camera, const glm::ivec2& size, double pixels);

}  // namespace edgesplat

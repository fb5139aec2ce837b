// Volumes block by block: which blocks can hold splats, and which of them a picture needs.
#pragma once

#include "engine/store/volume_store.h"
#include "engine/volume/sample_source.h"

namespace edgesplat {

/// Voxels along a side of a block, without its border.
inline constexpr int kBlockCore = 128;

/// The most that a block of such a volume takes.
CollectionBlock largest_block(const glm::ivec3& dims);

/// The blocks of a plan that can hold splats, x fastest: not those that are transparent or buried whole, as far as the
/// bounds of their samples tell. `volume`: for the range that samples are scaled to.
std::vector<CollectionBlock> blocks_with_splats(const SampleSource& source, const Volume& volume,
                                                const CollectionPlan& plan);

/// The finest of `levels` levels, from `finest` on, whose voxels a splat can number; `levels` where none is.
int countable_level(const VolumeGeometry& geometry, int levels, int finest);

/// The coarsest of `levels` levels whose voxels are nowhere in the picture wider than `pixels`; 0 where level 0 is
/// wider already, or the volume reaches the plane of the eye.
int level_for(const VolumeGeometry& geometry, int levels, const Camera& camera, const glm::ivec2& size, double pixels);

}  // namespace edgesplat

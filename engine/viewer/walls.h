// What of a volume is solid to someone who moves through it, and how far away it is.
#pragma once

#include <glm/glm.hpp>
#include <limits>
#include <memory>

#include "engine/scene/clip_planes.h"
#include "engine/scene/scene.h"
#include "engine/volume/volume.h"

namespace edgesplat::viewer {

/// Solid is the matter of which one voxel (the mean of the three spacings) lets at most half of the light through:
/// extinction >= ln 2 / spacing at the interpolated value, by material or transfer function, inside the box of the
/// volume (half a voxel beyond the outermost centres) and not cut away. Distances are in mm, negative inside. Within
/// about two voxels of a surface they are those to the surface of the trilinear field itself; further away an exact
/// Euclidean distance transform (Felzenszwalb and Huttenlocher 2012) to all places where that surface crosses an edge
/// of the grid. At corners of clip planes and outside the volume they are lower bounds. Constant, and thread-safe.
class Walls {
  public:
    /// Voxels beyond which walls are found at a lower resolution.
    static constexpr std::size_t kMaxVoxelsInMemory = std::size_t{1} << 24, kMaxVoxelsPacked = std::size_t{1} << 23;

    /// Keeps the volume, or a coarser one made from it. Throws Error for a volume without voxels, for an invalid scene,
    /// and where a packed file cannot be read.
    Walls(const std::shared_ptr<const Volume>& volume, const Scene& scene);
    /// The same matter with other clip planes; costs nothing.
    Walls(const Walls& walls, const Clip& clip);

    bool solid(const glm::dvec3& world) const;
    /// mm to the nearest surface, negative in solid matter; infinity where nothing is solid.
    double distance(const glm::dvec3& world) const;
    /// Unit, world: the way to more room (out of the matter, when inside). Where all ways are alike, any.
    glm::dvec3 away(const glm::dvec3& world) const;
    /// mm: how far a straight way in a direction (any length > 0) is free, at most `limit`; 0 from inside.
    double free_way(const glm::dvec3& world, const glm::dvec3& direction,
                    double limit = std::numeric_limits<double>::infinity()) const;

    double voxel() const;                    ///< mm, smallest spacing of the grid below
    bool any() const;                        ///< whether anything is solid, clip planes aside
    glm::ivec3 dims() const;                 ///< of the grid that walls were found on: the volume's or a coarser one
    const VolumeGeometry& geometry() const;  ///< of that grid
    /// The distance at a voxel's centre of that grid, without refinement near surfaces; fast.
    double distance_at(const glm::ivec3& voxel) const;

  private:
    struct Matter;
    double cut(const glm::dvec3& world) const;
    std::shared_ptr<const Matter> matter_;
    Clip clip_;  ///< unit normals
};

}  // namespace edgesplat::viewer

// Solid parts of a volume, and distances to them, for moving through it.
#pragma once

#include <glm/glm.hpp>
#include <limits>
#include <memory>

#include "engine/scene/clip_planes.h"
#include "engine/scene/scene.h"
#include "engine/volume/volume.h"

namespace edgesplat::viewer {

/// Matter is solid if one voxel of it (the mean of the three spacings) absorbs at least half of the light: extinction
/// >= ln 2 / spacing at the interpolated value, by material or transfer function. It must be inside the box of the
/// volume (half a voxel beyond the outermost centres) and not clipped.
///
/// Distances are in mm, negative inside. Within about two voxels of a surface they are those to the surface of the
/// trilinear field. Further away they are an exact Euclidean distance transform (Felzenszwalb and Huttenlocher 2012) to
/// all crossings of that surface with edges of the grid. At corners of clip planes and outside the volume they are
/// lower bounds. Immutable and thread-safe.
class Walls {
  public:
    /// Numbers of voxels beyond which walls are computed at a lower resolution.
    static constexpr std::size_t kMaxVoxelsInMemory = std::size_t{1} << 24, kMaxVoxelsPacked = std::size_t{1} << 23;

    /// Keeps the volume, or a coarser one made from it. Throws Error: a volume without voxels, an invalid scene, an
    /// unreadable packed file.
    Walls(const std::shared_ptr<const Volume>& volume, const Scene& scene);
    /// The same matter with other clip planes; costs nothing.
    Walls(const Walls& walls, const Clip& clip);

    bool solid(const glm::dvec3& world) const;
    /// mm to the nearest surface, negative in solid matter; infinity if nothing is solid.
    double distance(const glm::dvec3& world) const;
    /// Unit, world: the direction to more room (out of matter, when inside); arbitrary if all directions are equal.
    glm::dvec3 away(const glm::dvec3& world) const;
    /// Free length of a straight line in a direction (any length > 0), mm, at most `limit`; 0 from inside.
    double free_distance(const glm::dvec3& world, const glm::dvec3& direction,
                         double limit = std::numeric_limits<double>::infinity()) const;

    double voxel() const;     ///< mm, smallest spacing of the grid
    bool any() const;         ///< whether anything is solid, without clip planes
    glm::ivec3 dims() const;  ///< of the grid on which walls were computed: the volume's or a coarser one
    const VolumeGeometry& geometry() const;  ///< of that grid
    /// The distance at the centre of a voxel of that grid, without refinement near surfaces; fast.
    double distance_at(const glm::ivec3& voxel) const;

  private:
    struct Matter;
    double cut(const glm::dvec3& world) const;
    std::shared_ptr<const Matter> matter_;
    Clip clip_;  ///< unit normals
};

}  // namespace edgesplat::viewer

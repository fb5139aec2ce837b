// Parts of Walls: intervals of values, distances on the grid, surfaces in its cells.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "engine/scene/scene.h"
#include "engine/volume/volume.h"

namespace edgesplat::viewer {

/// The value axis, divided into intervals that are alternately solid and not solid.
struct SolidValues {
    std::vector<double> flips;  ///< ascending; a flip belongs to the interval above it
    bool solid_below = false;   ///< whether values below the first flip are solid

    /// Number of flips <= value.
    int interval(double value) const {
        int n = 0;
        while (n < static_cast<int>(flips.size()) && flips[static_cast<std::size_t>(n)] <= value)
            ++n;
        return n;
    }
    bool solid_interval(int n) const { return solid_below != (n % 2 != 0); }
    bool solid(double value) const { return solid_interval(interval(value)); }
};

/// Values are solid where extinction >= ln 2 / voxel (mm).
SolidValues solid_values(const Scene& scene, double voxel);

/// Distance in mm from every voxel's centre to the nearest place where linear interpolation along an edge of the grid
/// reaches a flip; infinity if there is none. Exact for orthogonal axes (Felzenszwalb and Huttenlocher 2012).
std::vector<float> distances_to_crossings(const Volume& volume, const SolidValues& values);

/// The trilinear field of a volume in memory, by cell; the outermost samples continue it beyond the border.
struct CellField {
    const Volume& volume;
    glm::dmat3 to_index;  ///< linear part

    explicit CellField(const Volume& v) : volume(v), to_index(glm::inverse(v.geometry.index_to_world_axes)) {}
    double sample(const glm::ivec3& i) const;
    std::array<double, 8> corners(const glm::ivec3& cell) const;
    double value(const glm::dvec3& index) const;
    /// World gradient, per mm.
    glm::dvec3 gradient(const glm::dvec3& index) const;
};

/// The cells of a grid that a surface crosses: one bit per cell, indexed by its lowest corner.
std::vector<bool> crossed_cells(const Volume& volume, const SolidValues& values);

/// The point of the solid matter's surface nearest to a place in index space, world mm relative to the volume's origin;
/// nullopt if it is further away than `radius` mm.
std::optional<glm::dvec3> nearest_on_surface(const CellField& field, const SolidValues& values,
                                             const std::vector<bool>& crossed, const glm::dvec3& index, double radius);

}  // namespace edgesplat::viewer

#include "engine/volume/chord.h"

#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>

#include "engine/volume/parallel.h"

namespace edgesplat {

double mean_chord(const Volume& volume, double iso) {
    const glm::ivec3 dims = volume.geometry.dims;
    std::atomic<std::int64_t> voxels = 0;
    std::array<std::atomic<std::int64_t>, 3> ends{};  // sides of voxels of matter that face none, per axis
    parallel_for(dims.z, [&](int begin, int end) {
        std::int64_t count = 0;
        std::array<std::int64_t, 3> found{};
        const auto is_matter = [&](glm::ivec3 p) {
            const std::size_t at = volume.index_of(p.x, p.y, p.z);
            return volume.has_data(at) && static_cast<double>(volume.values[at]) >= iso;
        };
        for (int z = begin; z < end; ++z)
            for (int y = 0; y < dims.y; ++y)
                for (int x = 0; x < dims.x; ++x) {
                    const glm::ivec3 p(x, y, z);
                    if (!is_matter(p)) continue;
                    ++count;
                    for (int axis = 0; axis < 3; ++axis)
                        for (const int way : {-1, 1}) {
                            glm::ivec3 beside = p;
                            beside[axis] += way;
                            const bool inside = beside[axis] >= 0 && beside[axis] < dims[axis];
                            if (!inside || !is_matter(beside)) ++found[static_cast<std::size_t>(axis)];
                        }
                }
        voxels += count;
        for (std::size_t axis = 0; axis < 3; ++axis)
            ends[axis] += found[axis];
    });
    // A line along an axis ends twice in each of its pieces. Per area, the lines of an axis are as many as there are
    // sides.
    const glm::dmat3& axes = volume.geometry.index_to_world_axes;
    double area = 0;
    for (int axis = 0; axis < 3; ++axis)
        area += static_cast<double>(ends[static_cast<std::size_t>(axis)]) *
                glm::length(glm::cross(axes[(axis + 1) % 3], axes[(axis + 2) % 3]));
    if (!(area > 0)) return 0;
    return 6 * static_cast<double>(voxels) * std::abs(glm::determinant(axes)) / area;
}

}  // namespace edgesplat

#include "engine/scene/rim.h"

#include <algorithm>

#include "engine/scene/scene.h"

namespace edgesplat {
namespace {

constexpr double kRimVoxels = 6;
constexpr double kInset = 1.5;  ///< from half a voxel beyond the outermost samples

/// Whether the volume's grid reaches beyond some part of a side of another grid, by half a voxel of that grid.
bool continues_beyond(const VolumeGeometry& volume, const VolumeGeometry& grid, int axis, double outwards) {
    const int across = (axis + 1) % 3, down = (axis + 2) % 3;
    const glm::dvec3 last(grid.dims - 1);
    glm::dvec3 at;
    at[axis] = outwards < 0 ? -1 : last[axis] + 1;
    for (const double a : {0.02, 0.25, 0.5, 0.75, 0.98})
        for (const double b : {0.02, 0.25, 0.5, 0.75, 0.98}) {
            at[across] = a * last[across];
            at[down] = b * last[down];
            const glm::dvec3 there = volume.to_index(grid.to_world(at));
            const auto inside = glm::greaterThan(there, glm::dvec3(-0.5));
            if (glm::all(inside) && glm::all(glm::lessThan(there, glm::dvec3(volume.dims) - 0.5))) return true;
        }
    return false;
}

/// From 0 to 1 with two continuous derivatives.
double risen(double t) {
    t = std::clamp(t, 0.0, 1.0);
    return t * t * t * (10 + t * (6 * t - 15));
}

}  // namespace

double Rim::share(const glm::dvec3& at) const {
    double inside = 1;
    for (const RimSide& side : sides) {
        const double depth = -glm::dot(side.plane.normal, at - side.plane.point);
        if (side.inner) inside *= risen(depth / width);
        if (!side.inner && !within) inside *= depth > 0 ? 1 : 0;
    }
    return within || !any() ? inside : 1 - inside;
}

Rim rim_of(const VolumeGeometry& grid, const std::vector<VolumeGeometry>& others, double width) {
    Rim rim;
    const glm::dvec3 spacing = grid.spacing(), size = spacing * glm::dvec3(grid.dims);
    for (const VolumeGeometry& other : others) {
        const glm::dvec3 s = other.spacing();
        if (!(width > 0)) rim.width = std::max({rim.width, kRimVoxels * s.x, kRimVoxels * s.y, kRimVoxels * s.z});
    }
    rim.width = std::min(width > 0 ? width : rim.width, 0.5 * std::min({size.x, size.y, size.z}));
    const glm::dmat3 normals = glm::transpose(glm::inverse(grid.index_to_world_axes));
    const glm::dvec3 middle = 0.5 * glm::dvec3(grid.dims - 1);
    for (int axis = 0; axis < 3; ++axis)
        for (const double outwards : {-1.0, 1.0}) {
            const auto continues = [&](const VolumeGeometry& other) {
                return continues_beyond(other, grid, axis, outwards);
            };
            const bool inner = rim.width > 0 && std::ranges::any_of(others, continues);
            glm::dvec3 at = middle;
            at[axis] += outwards * std::max(0.5 * grid.dims[axis] - (inner ? kInset : 0), 0.0);
            rim.sides.push_back({{grid.to_world(at), outwards * unit(normals[axis])}, inner});
        }
    return rim;
}

}  // namespace edgesplat

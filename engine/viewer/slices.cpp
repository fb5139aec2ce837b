#include "engine/viewer/slices.h"

#include <algorithm>
#include <cmath>

#include "engine/error.h"
#include "engine/scene/views.h"
#include "engine/volume/packed_volume.h"

namespace edgesplat::viewer {
namespace {

constexpr int kMostPixels = 1024;  // per side, for a packed volume

/// The world axis nearest to an axis of the volume, and whether both have opposite directions.
struct Heading {
    int axis = 0;
    bool against = false;
};
Heading heading(const glm::dvec3& direction) {
    Heading h;
    for (int k = 1; k < 3; ++k)
        if (std::abs(direction[k]) > std::abs(direction[h.axis])) h.axis = k;
    h.against = direction[h.axis] < 0;
    return h;
}

}  // namespace

Slice slice(const Volume& volume, int axis, const glm::dvec3& voxel, double low, double high) {
    if (axis < 0 || axis > 2) fail("slice axis: {}, expected 0, 1 or 2", axis);
    if (!(low < high) || !std::isfinite(low) || !std::isfinite(high))
        fail("slice window: {} to {}, expected two numbers, the lower first", low, high);
    if (!std::isfinite(voxel.x + voxel.y + voxel.z))
        fail("slice voxel: ({}, {}, {}) is not finite", voxel.x, voxel.y, voxel.z);
    const VolumeGeometry& geometry = volume.geometry;
    Slice s;
    s.axis = axis;
    s.across = {axis == 0 ? 1 : 0, axis == 2 ? 1 : 2};
    // An axis along the world's z is vertical, whatever the order of the volume's axes.
    if (heading(geometry.index_to_world_axes[s.across.x]).axis == 2) std::swap(s.across.x, s.across.y);
    const Heading right = heading(geometry.index_to_world_axes[s.across.x]),
                  down = heading(geometry.index_to_world_axes[s.across.y]);
    s.turned = {right.against, down.against != (down.axis == 2)};
    s.depth = std::clamp(std::round(voxel[axis]), 0.0, geometry.dims[axis] - 1.0);

    int level = 0;
    if (volume.packed) {
        const auto side = [&](int at) {
            const glm::ivec3& dims = volume.packed->geometry(at).dims;
            return std::max(dims[s.across.x], dims[s.across.y]);
        };
        while (level + 1 < volume.packed->levels() && side(level) > kMostPixels)
            ++level;
    }
    s.voxels = std::ldexp(1.0, level);
    const glm::ivec3 dims = volume.packed ? volume.packed->geometry(level).dims : geometry.dims;
    s.width = dims[s.across.x];
    s.height = dims[s.across.y];
    const glm::dvec3 spacing = geometry.spacing();
    s.pixel_mm = glm::dvec2(spacing[s.across.x], spacing[s.across.y]) * s.voxels;
    s.cross = pixel_at(s, voxel);

    glm::ivec3 first(0), size = dims;
    first[axis] = std::min(static_cast<int>(s.depth / s.voxels), dims[axis] - 1);
    size[axis] = 1;
    std::vector<float> read;
    if (volume.packed) {
        read.resize(static_cast<std::size_t>(s.width) * static_cast<std::size_t>(s.height));
        volume.packed->read(level, first, size, read);
    }
    // `read` has the same order: x is fastest.
    const auto sample = [&](const glm::ivec3& i) {
        if (!volume.packed) return volume.at(i.x, i.y, i.z);
        const glm::ivec3 at = i - first;
        return read[(static_cast<std::size_t>(at.z) * static_cast<std::size_t>(size.y) +
                     static_cast<std::size_t>(at.y)) *
                        static_cast<std::size_t>(size.x) +
                    static_cast<std::size_t>(at.x)];
    };
    s.grey.reserve(static_cast<std::size_t>(s.width) * static_cast<std::size_t>(s.height));
    const double scale = 255 / (high - low);
    for (int row = 0; row < s.height; ++row)
        for (int column = 0; column < s.width; ++column) {
            glm::ivec3 i = first;
            i[s.across.x] = s.turned.x ? s.width - 1 - column : column;
            i[s.across.y] = s.turned.y ? s.height - 1 - row : row;
            const double grey = std::clamp((static_cast<double>(sample(i)) - low) * scale, 0.0, 255.0);
            s.grey.push_back(static_cast<std::uint8_t>(std::lround(grey)));
        }
    return s;
}

// A pixel covers `voxels` voxels, from the volume's border on (half a voxel before the first centre). The last pixel
// may reach beyond the volume.
glm::dvec3 voxel_at(const Slice& slice, const glm::dvec2& pixel) {
    glm::dvec3 voxel(slice.depth);
    const glm::dvec2 size(slice.width, slice.height);
    for (int k = 0; k < 2; ++k) {
        const double from_border = slice.turned[k] ? size[k] - pixel[k] : pixel[k];
        voxel[slice.across[k]] = from_border * slice.voxels - 0.5;
    }
    return voxel;
}

std::array<char, 4> slice_letters(const Slice& slice, const VolumeGeometry& geometry) {
    const auto letter = [&](const glm::dvec2& step) {
        const glm::dvec3 way = voxel_at(slice, slice.cross + step) - voxel_at(slice, slice.cross);
        return patient_letter(geometry.index_to_world_axes * way);
    };
    return {letter({-1, 0}), letter({1, 0}), letter({0, -1}), letter({0, 1})};
}

glm::dvec2 pixel_at(const Slice& slice, const glm::dvec3& voxel) {
    const glm::dvec2 size(slice.width, slice.height);
    glm::dvec2 pixel;
    for (int k = 0; k < 2; ++k) {
        const double from_border = (voxel[slice.across[k]] + 0.5) / slice.voxels;
        pixel[k] = slice.turned[k] ? size[k] - from_border : from_border;
    }
    return pixel;
}

}  // namespace edgesplat::viewer

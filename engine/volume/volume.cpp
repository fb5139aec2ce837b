#include "engine/volume/volume.h"

#include <bit>
#include <cmath>
#include <limits>

#include "engine/error.h"

namespace edgesplat {
namespace {

// FNV-1a on 32-bit words instead of bytes: four times as fast, and only ever compared with itself.
class Fnv {
  public:
    void add(std::uint32_t word) { hash_ = (hash_ ^ word) * 0x100000001b3ULL; }
    void add(double value) {
        const auto bits = std::bit_cast<std::uint64_t>(value + 0.0);  // -0 and 0 are the same place
        add(static_cast<std::uint32_t>(bits));
        add(static_cast<std::uint32_t>(bits >> 32));
    }
    std::uint64_t hash() const { return hash_; }

  private:
    std::uint64_t hash_ = 0xcbf29ce484222325ULL;
};

void check_geometry(const Volume& volume) {
    const auto& geometry = volume.geometry;
    const auto& dims = geometry.dims;
    if (dims.x < 1 || dims.y < 1 || dims.z < 1)
        fail("{}: dims {} x {} x {}: each must be at least 1", volume.name, dims.x, dims.y, dims.z);
    if (volume.values.size() != geometry.voxel_count())
        fail("{}: {} samples for dims {} x {} x {}", volume.name, volume.values.size(), dims.x, dims.y, dims.z);
    for (int axis = 0; axis < 3; ++axis) {
        const auto column = geometry.index_to_world_axes[axis];
        const double length = glm::length(column);
        if (!std::isfinite(length) || !std::isfinite(geometry.origin[axis]))
            fail("{}: the spacing, direction or origin of axis {} is not finite", volume.name, axis);
        if (!(length > 0)) fail("{}: the spacing of axis {} is 0", volume.name, axis);
    }
    const auto spacing = geometry.spacing();
    const double volume_ratio =
        std::abs(glm::determinant(geometry.index_to_world_axes)) / (spacing.x * spacing.y * spacing.z);
    if (!(volume_ratio > 1e-6)) fail("{}: its three axes lie in one plane", volume.name);
}

}  // namespace

void finish_volume(Volume& volume) {
    check_geometry(volume);
    float low = std::numeric_limits<float>::infinity(), high = -low;
    std::size_t bad = 0;
    for (const float value : volume.values) {
        if (!std::isfinite(value)) {
            ++bad;
            continue;
        }
        low = value < low ? value : low;
        high = value > high ? value : high;
    }
    volume.non_finite_count = bad;
    const bool any = bad < volume.values.size();
    volume.min_value = any ? low : 0.0F;
    volume.max_value = any ? high : 0.0F;
    if (bad > 0) {
        for (float& value : volume.values)
            if (!std::isfinite(value)) value = volume.min_value;
    }

    Fnv fnv;
    for (int axis = 0; axis < 3; ++axis)
        fnv.add(static_cast<std::uint32_t>(volume.geometry.dims[axis]));
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            fnv.add(volume.geometry.index_to_world_axes[column][row]);
    for (int axis = 0; axis < 3; ++axis)
        fnv.add(volume.geometry.origin[axis]);
    for (const float value : volume.values)
        fnv.add(std::bit_cast<std::uint32_t>(value));
    volume.checksum = fnv.hash();
}

}  // namespace edgesplat

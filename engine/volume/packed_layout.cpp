// The layout of packed volumes, shared by writer and reader.
#include <algorithm>

#include "engine/volume/packed_internal.h"

namespace edgesplat::detail {

Hdf5Extent extent_of(const glm::ivec3& v) {
    return {static_cast<std::uint64_t>(v.z), static_cast<std::uint64_t>(v.y), static_cast<std::uint64_t>(v.x)};
}

glm::ivec3 bricks_of(const glm::ivec3& dims) {
    return (dims + (PackedVolume::kBrick - 1)) / PackedVolume::kBrick;
}

std::string level_path(int level, std::string_view name) {
    return fmt::format("/levels/{}/{}", level, name);
}

std::vector<VolumeGeometry> level_geometries(const VolumeGeometry& finest) {
    std::vector<VolumeGeometry> levels{finest};
    while (std::max({levels.back().dims.x, levels.back().dims.y, levels.back().dims.z}) > kCoarsestSide) {
        const double factor = static_cast<double>(std::uint64_t{1} << levels.size());
        VolumeGeometry next;
        next.dims = (levels.back().dims + 1) / 2;
        next.index_to_world_axes = finest.index_to_world_axes * factor;
        // The centre of the averaged box.
        next.origin = finest.to_world(glm::dvec3((factor - 1) / 2));
        levels.push_back(next);
    }
    return levels;
}

void check_extent(const std::string& path, const std::string& name, const Hdf5Extent& found, const Hdf5Extent& wanted) {
    if (found != wanted)
        fail("{}: {}: {} (slowest axis first), expected {}", path, name, fmt::join(found, " x "),
             fmt::join(wanted, " x "));
}

std::size_t bin_of(float value, double low, double scale, std::size_t bins) {
    const auto bin = static_cast<std::size_t>(std::max(0.0, (static_cast<double>(value) - low) * scale));
    return std::min(bin, bins - 1);
}

}  // namespace edgesplat::detail

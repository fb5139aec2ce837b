#include "engine/volume/changed_box.h"

#include <algorithm>
#include <span>

namespace edgesplat {
namespace {

bool same_grid(const VolumeGeometry& a, const VolumeGeometry& b) {
    return a.dims == b.dims && a.index_to_world_axes == b.index_to_world_axes && a.origin == b.origin;
}

}  // namespace

std::optional<VoxelBox> changed_box(const Volume& before, const Volume& now) {
    const bool comparable =
        same_grid(before.geometry, now.geometry) && before.min_value == now.min_value &&
        before.max_value == now.max_value && !before.values.empty() && before.values.size() == now.values.size() &&
        before.shown_labels == now.shown_labels &&
        (before.no_data == now.no_data || (before.no_data && now.no_data && *before.no_data == *now.no_data));
    if (!comparable) return std::nullopt;
    const glm::ivec3 dims = now.geometry.dims;
    const auto width = static_cast<std::size_t>(dims.x);
    VoxelBox box;
    for (int z = 0; z < dims.z; ++z) {
        for (int y = 0; y < dims.y; ++y) {
            const std::size_t row =
                (static_cast<std::size_t>(z) * static_cast<std::size_t>(dims.y) + static_cast<std::size_t>(y)) * width;
            const auto old_row = std::span(before.values).subspan(row, width);
            const auto new_row = std::span(now.values).subspan(row, width);
            const auto first = std::ranges::mismatch(old_row, new_row).in1 - old_row.begin();
            if (first == dims.x) continue;
            auto last = dims.x - 1;
            while (old_row[static_cast<std::size_t>(last)] == new_row[static_cast<std::size_t>(last)])
                --last;
            box.add({{static_cast<int>(first), y, z}, {last, y, z}});
        }
    }
    return box;
}

}  // namespace edgesplat

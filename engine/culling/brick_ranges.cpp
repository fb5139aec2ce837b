#include "engine/culling/brick_ranges.h"

#include <algorithm>
#include <cmath>

#include "engine/volume/filters.h"
#include "engine/volume/parallel.h"
#include "shaders/shared/limits.h"

namespace edgesplat {
namespace {

constexpr int kSide = static_cast<int>(shader::BRICK);
// A surfel depends on samples up to 2 voxels away, and a face at the volume's border on voxels of a brick beside it.
constexpr int kMargin = 3;

struct Window {
    int first, last;
};
/// The voxels of brick `number` along an axis of `size` voxels, and those beside it.
Window window_of(int number, int size) {
    return {std::max(kSide * number - kMargin, 0), std::min(kSide * (number + 1) + kMargin, size) - 1};
}

}  // namespace

BrickRanges::BrickRanges(const Volume& volume) {
    const glm::ivec3 dims = volume.geometry.dims, last = dims - 1, bricks = (dims + kSide - 1) / kSide;
    const auto nx = static_cast<std::size_t>(bricks.x), ny = static_cast<std::size_t>(bricks.y);
    const auto merge = [](Range& range, const Range& other) {
        range.least = std::min(range.least, other.least);
        range.most = std::max(range.most, other.most);
    };
    const auto value = [&](const glm::ivec3& i) {
        return scaled_sample(volume, volume.sample(volume.index_of(i.x, i.y, i.z)));
    };
    // Of a voxel, with the border beside it.
    const auto at = [&](const glm::ivec3& i) {
        const float here = value(i);
        Range range{here, here};
        for (int axis = 0; axis < 3; ++axis) {
            if (i[axis] != 0 && i[axis] != last[axis]) continue;
            glm::ivec3 before = i;
            before[axis] = std::clamp(i[axis] == 0 ? 1 : i[axis] - 1, 0, last[axis]);
            const float beyond = scaled_at_border(here, value(before));
            merge(range, {beyond, beyond});
        }
        return range;
    };
    constexpr Range kNone{3e38F, -3e38F};
    // Of each brick within one slice of voxels; then of its slices.
    std::vector<Range> in_slices(nx * ny * static_cast<std::size_t>(dims.z), kNone);
    parallel_for(dims.z, [&](int begin, int end) {
        std::vector<Range> row(static_cast<std::size_t>(dims.x));
        std::vector<Range> of_row(nx);
        for (int z = begin; z < end; ++z)
            for (int y = 0; y < dims.y; ++y) {
                for (int x = 0; x < dims.x; ++x)
                    row[static_cast<std::size_t>(x)] = at({x, y, z});
                for (int b = 0; b < bricks.x; ++b) {
                    const auto [first, final] = window_of(b, dims.x);
                    Range range = kNone;
                    for (int x = first; x <= final; ++x)
                        merge(range, row[static_cast<std::size_t>(x)]);
                    of_row[static_cast<std::size_t>(b)] = range;
                }
                for (int b = 0; b < bricks.y; ++b) {
                    const auto [first, final] = window_of(b, dims.y);
                    if (y < first || y > final) continue;
                    Range* const slice =
                        in_slices.data() + (static_cast<std::size_t>(z) * ny + static_cast<std::size_t>(b)) * nx;
                    for (std::size_t i = 0; i < nx; ++i)
                        merge(slice[i], of_row[i]);
                }
            }
    });
    bricks_.assign(nx * ny * static_cast<std::size_t>(bricks.z), kNone);
    for (int b = 0; b < bricks.z; ++b) {
        const auto [first, final] = window_of(b, dims.z);
        for (int z = first; z <= final; ++z)
            for (std::size_t i = 0; i < nx * ny; ++i)
                merge(bricks_[static_cast<std::size_t>(b) * nx * ny + i],
                      in_slices[static_cast<std::size_t>(z) * nx * ny + i]);
    }
}

std::vector<std::uint32_t> BrickRanges::list(std::span<const float> iso, bool only_ends) const {
    const auto material_of = [&](float sample) { return std::ranges::upper_bound(iso, sample) - iso.begin(); };
    std::vector<std::uint32_t> numbers;
    for (std::size_t i = 0; i < bricks_.size(); ++i) {
        const auto& [least, most] = bricks_[i];
        const bool ends = least < 0 || material_of(least) != material_of(most);
        if (ends || !only_ends) numbers.push_back(static_cast<std::uint32_t>(i) | (ends ? shader::BRICK_ENDS : 0U));
    }
    return numbers;
}

}  // namespace edgesplat

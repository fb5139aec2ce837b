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
    const auto value = [&](int x, int y, int z) {
        return scaled_sample(volume, volume.sample(volume.index_of(x, y, z)));
    };
    const auto add = [](Range& range, float sample) {
        range.least = std::min(range.least, sample);
        range.most = std::max(range.most, sample);
    };
    const auto merge = [](Range& range, const Range& other) {
        range.least = std::min(range.least, other.least);
        range.most = std::max(range.most, other.most);
    };
    constexpr Range kNone{3e38F, -3e38F};
    // Of each brick within one slice of voxels; then of its slices.
    std::vector<Range> in_slices(nx * ny * static_cast<std::size_t>(dims.z), kNone);
    parallel_for(dims.z, [&](int begin, int end) {
        std::vector<float> row(static_cast<std::size_t>(dims.x));
        std::vector<Range> of_row(nx);
        for (int z = begin; z < end; ++z)
            for (int y = 0; y < dims.y; ++y) {
                for (int x = 0; x < dims.x; ++x)
                    row[static_cast<std::size_t>(x)] = value(x, y, z);
                const auto extend = [&](Range& range, int x) {
                    const float here = row[static_cast<std::size_t>(x)];
                    // At the border, half a voxel beyond the outermost samples, the field is linear.
                    const glm::ivec3 at(x, y, z);
                    for (int axis = 0; axis < 3; ++axis) {
                        if (at[axis] != 0 && at[axis] != last[axis]) continue;
                        glm::ivec3 before = at;
                        before[axis] = std::clamp(at[axis] == 0 ? 1 : at[axis] - 1, 0, last[axis]);
                        add(range, std::max(1.5F * here - 0.5F * value(before.x, before.y, before.z), 0.0F));
                    }
                };
                for (int b = 0; b < bricks.x; ++b) {
                    const auto [first, final] = window_of(b, dims.x);
                    Range range = kNone;
                    for (int x = first; x <= final; ++x)
                        add(range, row[static_cast<std::size_t>(x)]);
                    const bool outermost = y == 0 || y == last.y || z == 0 || z == last.z;
                    for (int x = first; x <= final; ++x)
                        if (outermost || x == 0 || x == last.x) extend(range, x);
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

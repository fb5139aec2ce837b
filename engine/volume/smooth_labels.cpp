#include "engine/volume/smooth_labels.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "engine/volume/grid.h"
#include "engine/volume/parallel.h"

namespace edgesplat {
namespace {

// Least distance of a voxel from the surface, on its own side; before the last average, which then seldom needs the
// first; and of parts one voxel thick, so that they stay that thick. Voxels.
constexpr float kLabelSide = 0.05F, kHeldLabelSide = 0.15F, kThinLabelSide = 0.3F;
// How often the distances are averaged; and the voxels beside a voxel that each time count.
constexpr int kLabelRounds = 4, kAverageReach = 4;
// Voxels along each axis that are computed together: what they need fits into a core's cache.
constexpr int kTile = 32;

/// Some voxels of a field, with a margin in which the field's outermost samples are repeated.
struct Part {
    glm::ivec3 low, high;  ///< without the margin
    int margin = 0;
    glm::ivec3 size{0};  ///< with it
    std::vector<float> samples;

    std::size_t at(const glm::ivec3& p) const { return voxel_offset(size, p - low + margin); }
    std::size_t stride(int axis) const {
        return static_cast<std::size_t>(axis == 0 ? 1 : axis == 1 ? size.x : size.x * size.y);
    }
};

/// Calls work(p) for the voxels of [low, high).
template <typename Work>
void for_box(const glm::ivec3& low, const glm::ivec3& high, const Work& work) {
    for (int z = low.z; z < high.z; ++z)
        for (int y = low.y; y < high.y; ++y)
            for (int x = low.x; x < high.x; ++x)
                work(glm::ivec3(x, y, z));
}

struct Tiles {
    glm::ivec3 dims, count;

    explicit Tiles(const glm::ivec3& of) : dims(of), count((of + kTile - 1) / kTile) {}
    int all() const { return count.x * count.y * count.z; }
    glm::ivec3 place(int tile) const { return {tile % count.x, tile / count.x % count.y, tile / count.x / count.y}; }

    /// A tile's part of the field that value(offset) gives.
    template <typename Value>
    Part part(int tile, int margin, const Value& value) const {
        Part part;
        part.low = place(tile) * kTile;
        part.high = glm::min(part.low + kTile, dims);
        part.margin = margin;
        part.size = part.high - part.low + 2 * margin;
        part.samples.resize(static_cast<std::size_t>(part.size.x * part.size.y * part.size.z));
        auto to = part.samples.begin();
        for_box(part.low - margin, part.high + margin, [&](const glm::ivec3& p) {
            *to++ = value(voxel_offset(dims, glm::clamp(p, glm::ivec3(0), dims - 1)));
        });
        return part;
    }
};

/// Squares of distances to the nearest voxel on the other side, in voxels, with the own side's sign: within lines along
/// an axis, from those within planes or lines across it. Samples less than kLabelReach from the part's ends are wrong.
void find_others(const std::vector<float>& from, std::vector<float>& to, std::size_t stride) {
    to = from;
    for (std::size_t i = kLabelReach * stride; i + kLabelReach * stride < from.size(); ++i) {
        const float own = from[i];
        float nearest = std::abs(own);
        for (std::size_t k = 1; k <= kLabelReach; ++k)
            for (const float other : {from[i - k * stride], from[i + k * stride]}) {
                const float there = (other > 0) == (own > 0) ? std::abs(other) : 0.0F;
                nearest = std::min(nearest, there + static_cast<float>(k * k));
            }
        to[i] = own > 0 ? nearest : -nearest;
    }
}

/// Distances of voxels from the sides between them and the nearest voxels on the other side, about; and, per tile,
/// whether some are below kLabelReach.
std::vector<float> distances(const std::vector<std::uint32_t>& numbers, const Tiles& tiles, std::vector<char>& near) {
    constexpr float kFar = (kLabelReach + 0.5F) * (kLabelReach + 0.5F);
    std::vector<float> found(numbers.size());
    parallel_for(tiles.all(), [&](int begin, int end) {
        for (int tile = begin; tile < end; ++tile) {
            Part part = tiles.part(tile, kLabelReach, [&](std::size_t at) { return numbers[at] > 0 ? kFar : -kFar; });
            const auto is_first = [&](float side) { return side == part.samples.front(); };
            if (!std::ranges::all_of(part.samples, is_first)) {
                near[static_cast<std::size_t>(tile)] = 1;
                std::vector<float> next;
                for (int axis = 0; axis < 3; ++axis) {
                    find_others(part.samples, next, part.stride(axis));
                    part.samples.swap(next);
                }
            }
            for_box(part.low, part.high, [&](const glm::ivec3& p) {
                const float square = part.samples[part.at(p)];
                found[voxel_offset(tiles.dims, p)] = std::copysign(std::sqrt(std::abs(square)) - 0.5F, square);
            });
        }
    });
    return found;
}

/// The mean with weights 1, 4, 6, 4, 1 along each axis. Samples less than 2 from the part's ends are wrong.
void average(std::vector<float>& samples, const Part& part, std::vector<float>& scratch) {
    for (int axis = 0; axis < 3; ++axis) {
        const std::size_t stride = part.stride(axis);
        scratch = samples;
        for (std::size_t i = 2 * stride; i + 2 * stride < samples.size(); ++i)
            scratch[i] = (samples[i - 2 * stride] + samples[i + 2 * stride] +
                          4 * (samples[i - stride] + samples[i + stride]) + 6 * samples[i]) /
                         16;
        samples.swap(scratch);
    }
}

/// Whether a voxel is in a cube of 2 x 2 x 2 voxels on its side.
bool is_thick(const std::vector<std::uint32_t>& labels, const glm::ivec3& dims, const glm::ivec3& p) {
    const bool shown = labels[voxel_offset(dims, p)] > 0;
    const auto in_cube = [&](const glm::ivec3& way) {
        for (int i = 1; i < 8; ++i) {
            const glm::ivec3 there = p + way * glm::ivec3(i & 1, i >> 1 & 1, i >> 2);
            if ((labels[voxel_offset(dims, glm::clamp(there, glm::ivec3(0), dims - 1))] > 0) != shown) return false;
        }
        return true;
    };
    for (int i = 0; i < 8; ++i)
        if (in_cube(2 * glm::ivec3(i & 1, i >> 1 & 1, i >> 2) - 1)) return true;
    return false;
}

/// Whether a voxel belongs to a sheet, a strand or a speck: neither it nor a neighbour on its side is thick.
bool is_thin(const std::vector<std::uint32_t>& labels, const glm::ivec3& dims, const glm::ivec3& p) {
    if (is_thick(labels, dims, p)) return false;
    const bool shown = labels[voxel_offset(dims, p)] > 0;
    for (int i = 0; i < 6; ++i) {
        glm::ivec3 beside = p;
        beside[i >> 1] = std::clamp(p[i >> 1] + 2 * (i & 1) - 1, 0, dims[i >> 1] - 1);
        if ((labels[voxel_offset(dims, beside)] > 0) == shown && is_thick(labels, dims, beside)) return false;
    }
    return true;
}

}  // namespace

std::vector<float> depth_in_labels(const std::vector<std::uint32_t>& numbers, const glm::ivec3& dims) {
    const Tiles tiles(dims);
    std::vector<char> near(static_cast<std::size_t>(tiles.all()), 0);
    std::vector<float> depth = distances(numbers, tiles, near), next = depth;
    for (int round = 0; round < kLabelRounds; ++round) {
        parallel_for(tiles.all(), [&](int begin, int end) {
            std::vector<float> twice, scratch;
            for (int tile = begin; tile < end; ++tile) {
                // Whatever is not near a surface stays.
                if (near[static_cast<std::size_t>(tile)] == 0) continue;
                Part part = tiles.part(tile, kAverageReach, [&](std::size_t at) { return depth[at]; });
                average(part.samples, part, scratch);
                twice = part.samples;
                average(twice, part, scratch);
                for_box(part.low, part.high, [&](const glm::ivec3& p) {
                    const std::size_t at = voxel_offset(dims, p), here = part.at(p);
                    const float way = numbers[at] > 0 ? 1.0F : -1.0F;
                    const float within = way * (2 * part.samples[here] - twice[here]);
                    const bool thin = within < kThinLabelSide && is_thin(numbers, dims, p);
                    const float side = round + 1 < kLabelRounds ? kHeldLabelSide : kLabelSide;
                    next[at] = way * std::max(within, thin ? kThinLabelSide : side);
                });
            }
        });
        depth.swap(next);
    }
    return depth;
}

std::vector<float> smoothed_mask(const std::vector<std::uint32_t>& numbers, const glm::ivec3& dims) {
    std::vector<float> mask = depth_in_labels(numbers, dims);
    for (float& sample : mask)
        sample = std::clamp(0.5F + sample / (2.0F * kLabelReach), 0.0F, 1.0F);
    return mask;
}

}  // namespace edgesplat

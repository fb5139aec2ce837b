#include "engine/volume/cut.h"

#include <algorithm>
#include <cmath>

#include "engine/error.h"
#include "engine/volume/filters.h"
#include "engine/volume/grid.h"
#include "engine/volume/labels.h"
#include "engine/volume/parallel.h"

namespace edgesplat {
namespace {

/// Mean of (sample - iso) over matter; 0 without any.
double contrast_of(const Volume& volume, double iso) {
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t at = 0; at < volume.values.size(); ++at) {
        const double above = static_cast<double>(volume.values[at]) - iso;
        if (!volume.has_data(at) || !(above >= 0)) continue;
        sum += above;
        ++count;
    }
    return sum / static_cast<double>(std::max<std::size_t>(count, 1));
}

/// How deep places of a volume lie in a cutter's solid.
class Solid {
  public:
    Solid(const Cutter& cutter, const VolumeGeometry& cut) : grid_(cutter.volume->geometry) {
        const glm::dmat3 to_grid = glm::inverse(grid_.index_to_world_axes);
        axes_ = to_grid * cut.index_to_world_axes;
        begin_ = to_grid * (cut.origin - grid_.origin);
        for (int axis = 0; axis < 3; ++axis)
            per_voxel_[axis] = glm::length(glm::transpose(axes_)[axis]);
        const double contrast = contrast_of(*cutter.volume, cutter.iso);
        Volume volume = *cutter.volume, even = volume;
        for (std::size_t at = 0; at < volume.values.size(); ++at) {
            const double above = static_cast<double>(volume.values[at]) - cutter.iso;
            volume.values[at] = static_cast<float>(above);
            even.values[at] = static_cast<float>(std::clamp(above, -contrast, contrast));
        }
        // A finer grid has details that the volume's samples cannot follow.
        const double step = std::cbrt(std::abs(glm::determinant(axes_)));
        const auto smoothings = std::lround(std::clamp(kSmoothings * (step * step - 1), 0.0, kMostSmoothings));
        for (long i = 0; i < smoothings; ++i)
            even = box_filter(even);
        if (smoothings > 0) volume = even;
        for (int i = 0; i < kEvenings; ++i)
            even = box_filter(even);
        find_blocks(volume.values);
        coefficients_ = bspline_coefficients(volume.values, grid_.dims);
        directions_ = std::move(even.values);
    }

    /// Depth of a voxel of the volume, its voxels; positive in the solid; at most kCutReach.
    double depth(const glm::ivec3& voxel) const {
        const glm::dvec3 place = begin_ + axes_ * glm::dvec3(voxel);
        double inside = kCutReach;  // distance from the grid's border
        for (int axis = 0; axis < 3; ++axis) {
            const double beyond = std::max(-0.5 - place[axis], place[axis] - grid_.dims[axis] + 0.5);
            inside = std::min(inside, -beyond / per_voxel_[axis]);
        }
        if (inside <= -kCutReach) return -kCutReach;
        const glm::ivec3 cell = glm::clamp(glm::ivec3(glm::floor(place)), glm::ivec3(0), grid_.dims - 1);
        const signed char side = sides_[voxel_offset(blocks_, cell / kBlock)];
        const double surface = side != 0 ? side * kCutReach : distance(place);
        return std::clamp(std::min(surface, inside), -kCutReach, kCutReach);
    }

  private:
    static constexpr int kBlock = 4;               ///< voxels
    static constexpr double kSmoothings = 0.25;    ///< means over 3^3 voxels, for grids n times as fine: times n^2 - 1
    static constexpr double kMostSmoothings = 64;  ///< for grids 16 times as fine
    static constexpr int kEvenings = 2;   ///< so many more, and the field has a slope kCutReach from the surface
    static constexpr double kStep = 0.5;  ///< of the search for the surface, voxels
    static constexpr int kHalvings = 6;

    /// Along the slope to the surface.
    double distance(const glm::dvec3& place) const {
        const double side = spline_at(coefficients_, grid_.dims, place).w >= 0 ? 1 : -1;
        const glm::dvec3 slope = glm::transpose(axes_) * glm::dvec3(spline_at(directions_, grid_.dims, place));
        const double steepness = glm::length(slope);
        if (!(steepness > 0)) return side * kCutReach;
        const glm::dvec3 step = axes_ * (-side / steepness * slope);
        const auto passed = [&](double way) {
            return side * spline_at(coefficients_, grid_.dims, place + way * step).w < 0;
        };
        double near = 0, far = kStep;
        while (!passed(far)) {
            near = far;
            if (near >= kCutReach) return side * kCutReach;
            far += kStep;
        }
        for (int i = 0; i < kHalvings; ++i) {
            const double middle = 0.5 * (near + far);
            (passed(middle) ? far : near) = middle;
        }
        return side * 0.5 * (near + far);
    }

    /// The side of blocks around which no surface is near: 1 in the solid, -1 outside; 0: a surface is near.
    void find_blocks(const std::vector<float>& values) {
        blocks_ = (grid_.dims + kBlock - 1) / kBlock;
        sides_.assign(voxel_offset(blocks_, {0, 0, blocks_.z}), 0);
        for_blocks([&](const glm::ivec3& block) { return side_of(values, block * kBlock); });
        for (int axis = 0; axis < 3; ++axis) {
            // The spline's support, and the reach of distances.
            const double reach = std::ceil((2 + kCutReach * per_voxel_[axis]) / kBlock);
            const int most = static_cast<int>(std::min<double>(reach, blocks_[axis]));
            const std::vector<signed char> before = sides_;
            for_blocks([&](glm::ivec3 block) {
                const signed char side = before[voxel_offset(blocks_, block)];
                const int first = std::max(block[axis] - most, 0),
                          last = std::min(block[axis] + most, blocks_[axis] - 1);
                for (block[axis] = first; block[axis] <= last; ++block[axis])
                    if (before[voxel_offset(blocks_, block)] != side) return static_cast<signed char>(0);
                return side;
            });
        }
    }

    /// Sets the side of each block.
    template <typename Side>
    void for_blocks(const Side& side) {
        parallel_for(blocks_.z, [&](int begin, int end) {
            for (int z = begin; z < end; ++z)
                for (int y = 0; y < blocks_.y; ++y)
                    for (int x = 0; x < blocks_.x; ++x)
                        sides_[voxel_offset(blocks_, {x, y, z})] = side(glm::ivec3(x, y, z));
        });
    }

    signed char side_of(const std::vector<float>& values, const glm::ivec3& low) const {
        const glm::ivec3 last = glm::min(low + kBlock, grid_.dims) - 1;
        bool any = false, all = true;
        for (int z = low.z; z <= last.z; ++z)
            for (int y = low.y; y <= last.y; ++y)
                for (int x = low.x; x <= last.x; ++x) {
                    const bool in = values[voxel_offset(grid_.dims, {x, y, z})] >= 0;
                    any = any || in;
                    all = all && in;
                }
        return static_cast<signed char>(all ? 1 : any ? 0 : -1);
    }

    VolumeGeometry grid_;
    glm::dmat3 axes_{1};               ///< from a step between the volume's voxels to one on the grid
    glm::dvec3 begin_{0};              ///< the volume's first voxel on the grid
    glm::dvec3 per_voxel_{1};          ///< how far the place on the grid moves along each axis in one voxel, at most
    std::vector<float> coefficients_;  ///< of the spline whose zeros are the surface
    std::vector<float> directions_;    ///< of one that slopes farther around it
    glm::ivec3 blocks_{0};
    std::vector<signed char> sides_;
};

}  // namespace

Volume without_solids(const Volume& volume, double iso, std::span<const Cutter> cutters) {
    const auto need_samples = [](const Volume& one) {
        if (one.packed)
            fail("{}: volume.rule = \"cut\": a packed volume neither cuts nor is cut; expected volumes in memory",
                 one.name);
    };
    need_samples(volume);
    for (const Cutter& cutter : cutters)
        need_samples(*cutter.volume);
    std::vector<Solid> solids;
    for (const Cutter& cutter : cutters)
        solids.emplace_back(cutter, volume.geometry);
    const double contrast = contrast_of(volume, iso);
    Volume result = volume;
    std::vector<std::uint32_t> numbers;
    if (volume.shown_labels) numbers = volume.shown_labels->at;
    const glm::ivec3 dims = volume.geometry.dims;
    parallel_for(dims.z, [&](int begin, int end) {
        for (int z = begin; z < end; ++z)
            for (int y = 0; y < dims.y; ++y)
                for (int x = 0; x < dims.x; ++x) {
                    double kept = kCutReach;
                    for (const Solid& solid : solids)
                        kept = std::min(kept, -solid.depth({x, y, z}));
                    if (kept >= kCutReach) continue;
                    const std::size_t at = volume.index_of(x, y, z);
                    const double above = static_cast<double>(volume.values[at]) - iso;
                    // The same slope on both sides of the cut; inside matter, the rest of its value is reached later.
                    const double t = kept / kCutReach, rest = t > 0 ? std::max(above - contrast, 0.0) * t * t : 0;
                    result.values[at] = static_cast<float>(iso + std::min(above, contrast * t + rest * (3 - 2 * t)));
                    if (kept < 0 && !numbers.empty()) numbers[at] = 0;
                }
    });
    if (volume.shown_labels) result.shown_labels = sorted_labels(std::move(numbers), volume.shown_labels->on_scan);
    finish_volume(result);
    return result;
}

}  // namespace edgesplat

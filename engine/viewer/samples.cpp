#include "engine/viewer/samples.h"

#include <algorithm>
#include <cmath>

#include "engine/volume/grid.h"

namespace edgesplat::viewer {
namespace {

constexpr int kApron = 2;  // voxels around a brick, so that interpolation in it needs no other brick

}  // namespace

double Samples::at(const glm::ivec3& i) const {
    const glm::ivec3 dims = volume_.geometry.dims, c = glm::clamp(i, glm::ivec3(0), dims - 1);
    if (!volume_.packed) return static_cast<double>(volume_.values[voxel_offset(dims, c)]);
    const glm::ivec3 in_box = c - box_low_;
    if (glm::any(glm::lessThan(in_box, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(in_box, box_size_))) {
        constexpr int brick = PackedVolume::kBrick;
        const glm::ivec3 low = glm::max(c / brick * brick - kApron, glm::ivec3(0));
        const glm::ivec3 size = glm::min(c / brick * brick + brick + kApron, dims) - low;
        box_size_ = glm::ivec3(0);  // the box stays empty if reading fails
        box_.resize(voxel_offset(size, size - 1) + 1);
        volume_.packed->read(0, low, size, box_);
        box_low_ = low;
        box_size_ = size;
    }
    return static_cast<double>(box_[voxel_offset(box_size_, c - box_low_)]);
}

std::array<double, 8> Samples::corners(const glm::ivec3& cell) const {
    std::array<double, 8> v{};
    for (int k = 0; k < 8; ++k)
        v[static_cast<std::size_t>(k)] = at(cell + glm::ivec3(k & 1, (k >> 1) & 1, (k >> 2) & 1));
    return v;
}

double Samples::linear(const glm::dvec3& voxel) const {
    const glm::dvec3 p = glm::clamp(voxel, glm::dvec3(0), glm::dvec3(volume_.geometry.dims - 1));
    const glm::ivec3 cell(p);
    const glm::dvec3 t = p - glm::dvec3(cell);
    const std::array<double, 8> v = corners(cell);
    const auto x = [&](std::size_t k) { return std::lerp(v[k], v[k + 1], t.x); };
    return std::lerp(std::lerp(x(0), x(2), t.y), std::lerp(x(4), x(6), t.y), t.z);
}

glm::dvec3 Samples::gradient(const glm::dvec3& voxel) const {
    const glm::dvec3 last(volume_.geometry.dims - 1);
    glm::dvec3 g(0);
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 before = voxel, after = voxel;
        before[axis] = std::max(voxel[axis] - 1, 0.0);
        after[axis] = std::min(voxel[axis] + 1, last[axis]);
        if (after[axis] > before[axis]) g[axis] = (linear(after) - linear(before)) / (after[axis] - before[axis]);
    }
    return g;
}

double interpolated(const Volume& volume, const glm::dvec3& voxel) {
    return Samples(volume).linear(voxel);
}

}  // namespace edgesplat::viewer

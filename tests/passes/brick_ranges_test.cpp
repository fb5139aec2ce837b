// The list of bricks in which matter may end: none is missing in which a voxel is estimated or shows a surface, and
// bricks of one material are not listed.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>

#include "engine/culling/brick_ranges.h"
#include "engine/volume/filters.h"
#include "shaders/shared/limits.h"

namespace edgesplat::test {
namespace {

constexpr int kSide = static_cast<int>(shader::BRICK);

/// Smooth hills with some samples missing.
Volume hills(const glm::ivec3& dims, bool missing) {
    Volume volume;
    volume.geometry.dims = dims;
    volume.name = "hills";
    std::mt19937 random(7);
    std::uniform_real_distribution<float> noise(0, 0.02F);
    for (int z = 0; z < dims.z; ++z)
        for (int y = 0; y < dims.y; ++y)
            for (int x = 0; x < dims.x; ++x) {
                const float hill =
                    std::sin(0.11F * static_cast<float>(x)) * std::cos(0.07F * static_cast<float>(y + z));
                const bool gone = missing && x > 30 && x < 33 && y == 5 && z == 6;
                volume.values.push_back(gone ? std::numeric_limits<float>::quiet_NaN() : hill + noise(random));
            }
    finish_volume(volume);
    return volume;
}

/// Whether samples at most 3 voxels from the brick, or the field at the border beside it, are of several materials
/// or missing.
bool ends(const Volume& volume, const glm::ivec3& brick, std::span<const float> iso) {
    const glm::ivec3 last = volume.geometry.dims - 1;
    const auto scaled = [&](const glm::ivec3& i) {
        return scaled_sample(volume, volume.sample(volume.index_of(i.x, i.y, i.z)));
    };
    std::set<std::ptrdiff_t> materials;
    const auto add = [&](float value) { materials.insert(std::ranges::upper_bound(iso, value) - iso.begin()); };
    const glm::ivec3 low = glm::max(brick * kSide - 3, glm::ivec3(0));
    const glm::ivec3 high = glm::min((brick + 1) * kSide + 2, last);
    for (int z = low.z; z <= high.z; ++z)
        for (int y = low.y; y <= high.y; ++y)
            for (int x = low.x; x <= high.x; ++x) {
                const glm::ivec3 at(x, y, z);
                if (!volume.has_data(at)) return true;
                add(scaled(at));
                for (int axis = 0; axis < 3; ++axis) {
                    if (at[axis] != 0 && at[axis] != last[axis]) continue;
                    glm::ivec3 before = at;
                    before[axis] = at[axis] == 0 ? std::min(1, last[axis]) : at[axis] - 1;
                    add(std::max(1.5F * scaled(at) - 0.5F * scaled(before), 0.0F));
                }
            }
    return materials.size() > 1;
}

TEST(BrickRanges, ListTheBricksInWhichMatterMayEnd) {
    for (const glm::ivec3& dims : {glm::ivec3(70, 41, 33), glm::ivec3(40, 1, 9), glm::ivec3(5, 6, 7)})
        for (const bool missing : {false, true})
            for (const std::vector<float>& iso : {std::vector<float>{0.5F}, std::vector<float>{0.2F, 0.93F}}) {
                const Volume volume = hills(dims, missing);
                const std::vector<std::uint32_t> listed = BrickRanges(volume).list(iso, true);
                const glm::ivec3 bricks = (dims + kSide - 1) / kSide;
                std::vector<std::uint32_t> all;
                std::size_t found = 0;
                for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(bricks.x * bricks.y * bricks.z); ++i) {
                    const auto n = static_cast<int>(i);
                    const glm::ivec3 brick(n % bricks.x, n / bricks.x % bricks.y, n / bricks.x / bricks.y);
                    const bool in_list = std::ranges::find(listed, i | shader::BRICK_ENDS) != listed.end();
                    found += in_list ? 1U : 0U;
                    all.push_back(i | (in_list ? shader::BRICK_ENDS : 0U));
                    EXPECT_EQ(in_list, ends(volume, brick, iso)) << "brick " << i << " of " << dims.x;
                }
                EXPECT_EQ(found, listed.size());
                if (dims.x == 70) {
                    EXPECT_LT(found, all.size()) << "the scene should have bricks of one material";
                }
                EXPECT_EQ(BrickRanges(volume).list(iso, false), all);
            }
}

}  // namespace
}  // namespace edgesplat::test

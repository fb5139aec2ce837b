// Pass 2 against the reference: the same voxels in the same order of bricks.
#include <cmath>

#include "tests/passes/pass_fixture.h"

namespace edgesplat::test {
namespace {

std::vector<reference::SplatRecord> expected_records(const PassScene& s) {
    const auto values = scaled_field(s.volume);
    const reference::Field field{s.volume.geometry.dims, values, {}};
    const std::vector<reference::VoxelEdge> no_edges(values.size());
    const auto carried = reference::voxels_beside(field, s.scaled());
    return reference::collect_splats(field, s.scaled(), no_edges, s.scene, s.volume.geometry, s.settings, s.camera.eye,
                                     false, {}, carried);
}

TEST(CollectSplats, CollectsTheReferencesVoxelsInBrickOrder) {
    for (const PassScene& s : pass_scenes()) {
        SCOPED_TRACE(s.name);
        const auto got = device_records(prepared(s));
        auto want = expected_records(s);
        sort_by_brick(want, s.volume.geometry.dims);
        ASSERT_EQ(got.size(), want.size());
        for (std::size_t i = 0; i < want.size(); ++i) {
            ASSERT_EQ(got[i].voxel, want[i].voxel);
            ASSERT_EQ(got[i].material, want[i].material);
        }
    }
}

TEST(CollectSplats, CullsOnlyBuriedVoxels) {
    PassScene s = pass_scenes()[0];
    s.volume = sample(sphere_scene({40, 40, 40}, {19.5, 19.5, 19.5}, 15));
    const auto with = device_records(prepared(s));
    s.settings.cull_buried = false;
    const auto without = device_records(prepared(s));
    EXPECT_LT(with.size(), without.size());
    // All voxels of the outer layers remain: at an extinction of 4 per mm, nothing deeper than 4 voxels is visible.
    std::size_t outer = 0, kept = 0;
    const auto is_outer = [&](const reference::SplatRecord& r) {
        const auto v = static_cast<int>(r.voxel);
        return glm::length(glm::dvec3(v % 40, v / 40 % 40, v / 1600) - 19.5) > 11.5;
    };
    for (const auto& record : without)
        outer += is_outer(record) ? 1U : 0U;
    for (const auto& record : with)
        kept += is_outer(record) ? 1U : 0U;
    EXPECT_EQ(kept, outer);
}

TEST(CollectSplats, StoresThePapersPlanesUnchanged) {
    for (PassScene s : pass_scenes()) {
        SCOPED_TRACE(s.name);
        s.settings.warp = WarpFamily::Paper;
        DeviceUnderTest& state = prepared(s);
        const std::vector<reference::VoxelEdge> field_edges = device_field(state);
        std::size_t edges = 0;
        for (const auto& record : device_records(state)) {
            const auto& want = field_edges[record.voxel];
            ASSERT_EQ(record.edge.has_edge, want.has_edge);
            ASSERT_EQ(record.edge.n, want.n);
            ASSERT_EQ(record.edge.D, want.D);
            edges += want.has_edge ? 1U : 0U;
        }
        EXPECT_GT(edges, 500U);
    }
}

TEST(CollectSplats, EstimatesBothSidesOfEdgesOnlyForFaces) {
    PassScene s = pass_scenes()[0];
    const auto with_edges = [&] {
        std::size_t count = 0;
        for (const auto& edge : device_field(prepared(s)))
            count += edge.has_edge ? 1U : 0U;
        return count;
    };
    s.settings.warp = WarpFamily::Paper;
    const std::size_t visible = with_edges();
    s.settings.warp = WarpFamily::Face;
    EXPECT_GT(with_edges(), visible + visible / 2);
}

TEST(CollectSplats, DrawsTheBackgroundWithoutVisibleVoxels) {
    PassScene s = pass_scenes()[0];
    s.scene.iso_values = {2.0};
    DeviceUnderTest& state = prepared(s);
    EXPECT_EQ(state.lists().splat_count, 0U);
    s.scene.background = {0.25, 0.5, 0.125};
    state.draw(s.scene, s.camera, s.settings, {16, 8}, shader::PAYLOAD_COLOR);
    for (const auto& pixel : state.targets().output.mapped<glm::vec4>(128))
        EXPECT_EQ(pixel, glm::vec4(0.25F, 0.5F, 0.125F, 0.0F));
}

}  // namespace
}  // namespace edgesplat::test

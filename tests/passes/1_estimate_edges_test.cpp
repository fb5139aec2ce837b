// Pass 1 against the reference: the same plane for the same voxel, up to float32 and the 64 stored bits. faces_test.cpp
// tests the other estimators.

#include "tests/passes/pass_fixture.h"

namespace edgesplat::test {
namespace {

TEST(EstimateEdges, TaylorAgreesWithTheReference) {
    for (PassScene s : pass_scenes()) {
        SCOPED_TRACE(s.name);
        s.settings = paper_settings(s.settings);
        s.settings.cull_buried = false;  // the reference estimates buried voxels too
        DeviceUnderTest& state = prepared(s);
        const auto field_values = scaled_field(s.volume);
        const reference::Field field{s.volume.geometry.dims, field_values, {}};
        const auto expected = reference::estimate_edges(field, s.scaled(), s.settings, true);
        const auto got = device_field(state);
        ASSERT_EQ(got.size(), expected.size());

        std::size_t edges = 0, differ = 0;
        for (std::size_t i = 0; i < expected.size(); ++i) {
            edges += expected[i].has_edge ? 1U : 0U;
            differ += same_edge(got[i], expected[i]) ? 0U : 1U;
        }
        EXPECT_GE(edges, expected.size() / 50) << "the scene has too few edges for this test";
        // A voxel half-way between two ends of its interval may choose either; only such voxels may differ.
        EXPECT_LE(static_cast<double>(differ), 0.003 * static_cast<double>(edges)) << differ << " of " << edges;
    }
}

TEST(EstimateEdgesOff, StoresNormalsForLightButNoEdges) {
    PassScene s = pass_scenes()[0];
    s.settings.edges = EdgeEstimator::Off;
    DeviceUnderTest& state = prepared(s);
    std::size_t normals = 0;
    for (const auto& record : device_records(state)) {
        EXPECT_FALSE(record.edge.has_edge);
        normals += record.edge.has_normal ? 1U : 0U;
    }
    EXPECT_GT(normals, 100U);
}

TEST(EstimateEdgesOff, RunsNoPassWithoutLight) {
    PassScene s = pass_scenes()[0];
    s.settings.edges = EdgeEstimator::Off;
    s.scene.lights.clear();
    DeviceUnderTest& state = prepared(s);
    EXPECT_FALSE(static_cast<bool>(state.lists().edges));
    for (const auto& time : state.cost.times)
        EXPECT_NE(time.name, "1_estimate_edges");
}

}  // namespace
}  // namespace edgesplat::test

// Pass 1 against the reference: the same plane for the same voxel, up to float32 and the 64 stored bits.
#include <algorithm>
#include <cmath>

#include "tests/passes/pass_fixture.h"

namespace edgesplat::test {
namespace {

// A voxel half-way between two planes may take either: those are the few that may differ.
constexpr double kTies = 0.003;

class EstimateEdges : public testing::TestWithParam<EdgeEstimator> {};

TEST_P(EstimateEdges, AgreesWithTheReference) {
    for (PassScene s : pass_scenes()) {
        SCOPED_TRACE(s.name);
        s.settings.edges = GetParam();
        s.settings.cull_buried = false;  // the reference estimates buried voxels too
        RendererState& state = prepared(s);
        const auto field_values = scaled_field(s.volume);
        std::vector<float> coefficients;
        if (GetParam() == EdgeEstimator::Cubic)
            coefficients = bspline_coefficients(field_values, s.volume.geometry.dims);
        const reference::Field field{s.volume.geometry.dims, field_values, coefficients};
        const auto expected = reference::estimate_edges(field, s.scaled(), s.settings, true);
        const auto words = download<glm::uvec2>(state, state.volume_resources.edges);
        ASSERT_EQ(words.size(), expected.size());

        std::size_t edges = 0, differ = 0;
        double worst = 0;
        for (std::size_t i = 0; i < expected.size(); ++i) {
            const auto got = decode_edge(words[i].x, words[i].y);
            const auto& want = expected[i];
            edges += want.has_edge ? 1U : 0U;
            const bool same = same_edge(got, want);
            if (same && want.has_edge) worst = std::max(worst, std::abs(got.D - want.D));
            differ += same ? 0U : 1U;
        }
        EXPECT_GE(edges, expected.size() / 50) << "the scene has too few edges to say anything";
        EXPECT_LE(static_cast<double>(differ), kTies * static_cast<double>(edges)) << differ << " of " << edges;
        RecordProperty("worst_distance", std::to_string(worst));
    }
}

INSTANTIATE_TEST_SUITE_P(All, EstimateEdges,
                         testing::Values(EdgeEstimator::Taylor, EdgeEstimator::Quadratic, EdgeEstimator::March,
                                         EdgeEstimator::Cubic),
                         [](const auto& test) { return std::string(name_of(test.param)); });

TEST(EstimateEdgesOff, LeavesNormalsForLightAndNoEdge) {
    PassScene s = pass_scenes()[0];
    s.settings.edges = EdgeEstimator::Off;
    RendererState& state = prepared(s);
    std::size_t normals = 0;
    for (const auto& record : device_records(state)) {
        EXPECT_FALSE(record.edge.has_edge);
        normals += record.edge.has_normal ? 1U : 0U;
    }
    EXPECT_GT(normals, 100U);
}

TEST(EstimateEdgesOff, WithoutLightThereIsNoPassAndNoField) {
    PassScene s = pass_scenes()[0];
    s.settings.edges = EdgeEstimator::Off;
    s.scene.lights.clear();
    RendererState& state = prepared(s);
    EXPECT_FALSE(static_cast<bool>(state.volume_resources.edges));
    for (const auto& time : state.collection_times)
        EXPECT_NE(time.name, "1_estimate_edges");
}

}  // namespace
}  // namespace edgesplat::test

// Pass 2 against the reference: exactly the same voxels, brick by brick.
#include <cmath>

#include "tests/passes/pass_fixture.h"

namespace edgesplat::test {
namespace {

std::vector<reference::SplatRecord> expected_records(const PassScene& s) {
    const auto values = scaled_field(s.volume);
    const reference::Field field{s.volume.geometry.dims, values, {}};
    const std::vector<reference::VoxelEdge> no_edges(values.size());
    return reference::collect_splats(field, s.scaled(), no_edges, s.scene, s.volume.geometry, s.settings, s.camera.eye);
}

TEST(CollectSplats, TheSameVoxelsBrickByBrick) {
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

TEST(CollectSplats, BuriedVoxelsAreDroppedAndOnlyThey) {
    PassScene s = pass_scenes()[0];
    s.volume = sample(sphere_scene({40, 40, 40}, {19.5, 19.5, 19.5}, 15));
    const auto with = device_records(prepared(s));
    s.settings.cull_buried = false;
    const auto without = device_records(prepared(s));
    EXPECT_LT(with.size(), without.size());
    // Every voxel of the outer layers is still there: 4 voxels behind the surface nothing shows at 4 per mm.
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

/// What pass 1 left for every voxel.
std::vector<reference::VoxelEdge> device_field(RendererState& state) {
    std::vector<reference::VoxelEdge> edges;
    for (const auto& words : download<glm::uvec2>(state, state.volume_resources.edges)) {
        edges.push_back(decode_edge(words.x, words.y));
        edges.back().adopted = (words.y & shader::EDGE_ADOPTED) != 0;
    }
    return edges;
}

TEST(CollectSplats, RecordsHoldTheEdgesSmoothedAlongTheSurface) {
    for (const PassScene& s : pass_scenes()) {
        SCOPED_TRACE(s.name);
        RendererState& state = prepared(s);
        const std::vector<reference::VoxelEdge> field_edges = device_field(state);
        const auto values = scaled_field(s.volume);
        const reference::Field field{s.volume.geometry.dims, values, {}};
        const auto want = reference::smooth_edges(field, s.scaled(), s.settings, field_edges);
        std::size_t edges = 0, moved = 0;
        for (const auto& record : device_records(state)) {
            const auto& w = want[record.voxel];
            ASSERT_EQ(record.edge.has_edge, w.has_edge);
            ASSERT_LE(glm::length(record.edge.n - w.n), 1e-6);
            if (!w.has_edge) continue;
            ++edges;
            moved += std::abs(w.D - field_edges[record.voxel].D) > 1e-3 ? 1U : 0U;
            ASSERT_NEAR(record.edge.D, w.D, 1.3e-4);  // one step of the 16 bits
        }
        EXPECT_GT(edges, 500U);
        EXPECT_GT(moved, edges / 10) << "nothing was smoothed";
    }
}

TEST(CollectSplats, TraitsHoldTheCurvature) {
    for (PassScene s : pass_scenes()) {
        SCOPED_TRACE(s.name);
        s.settings.footprints = FootprintMode::Procedural;
        s.settings.edge_shape = EdgeShape::Curved;
        RendererState& state = prepared(s);
        const auto values = scaled_field(s.volume);
        const reference::Field field{s.volume.geometry.dims, values, {}};
        const auto want = reference::smooth_edges(field, s.scaled(), s.settings, device_field(state));
        const double most = most_curved(s.settings);
        double largest = 0;
        std::size_t differ = 0;
        const auto records = device_records(state);
        for (const auto& record : records) {
            if (!record.edge.has_edge) continue;
            largest = std::max(largest, std::abs(record.edge.curvature));
            EXPECT_EQ(record.edge.weight, 1);
            EXPECT_LE(std::abs(record.edge.curvature), most + 1e-6);
            // 16 bits of the largest curvature, and float32 sums of a few dozen terms. Foot points at the limit of 1.5
            // voxels, or normals at that of 37 degrees, may be counted on one side and not on the other.
            differ += std::abs(record.edge.curvature - want[record.voxel].curvature) > 1e-4 ? 1U : 0U;
        }
        EXPECT_GT(largest, s.name == "wall from inside" ? 0.001 : 0.1) << "nothing is curved";
        EXPECT_LE(differ, records.size() / 500);
    }
}

TEST(CollectSplats, TraitsHoldTheWeights) {
    for (PassScene s : pass_scenes()) {
        SCOPED_TRACE(s.name);
        s.settings.normalisation = Normalisation::Voxel;
        RendererState& state = prepared(s);
        const auto values = scaled_field(s.volume);
        const reference::Field field{s.volume.geometry.dims, values, {}};
        std::vector<reference::VoxelEdge> want = device_field(state);
        reference::weigh_kernels(field, s.settings, want);
        double low = 1, high = 1, worst = 0;
        for (const auto& record : device_records(state)) {
            EXPECT_EQ(record.edge.curvature, 0);
            const double weight = record.edge.weight;
            EXPECT_GE(weight, 0.25 - 1e-4);
            EXPECT_LE(weight, 4);
            low = std::min(low, weight);
            high = std::max(high, weight);
            worst = std::max(worst, std::abs(weight - want[record.voxel].weight));
        }
        EXPECT_TRUE(low < 0.9 || high > 1.1) << "every weight is 1";
        // 16 bits of 4 are 6e-5; float32 sums of kernels are good to 1e-5, and 1 / sum is at most 4.
        EXPECT_LE(worst, 5e-4);
    }
}

TEST(CollectSplats, TraitsHoldTheEdgeWeights) {
    std::vector<PassScene> scenes = pass_scenes();
    scenes.push_back(scenes[0]);
    scenes.back().name = "torus by a transfer function";
    scenes.back().scene.transfer = {{0.1, {1, 1, 1}, 0.1}, {0.9, {1, 1, 1}, 0.8}};
    for (PassScene s : scenes) {
        for (const EdgeShape shape : {EdgeShape::Plane, EdgeShape::Curved}) {
            SCOPED_TRACE(s.name);
            s.settings.normalisation = Normalisation::Edge;
            s.settings.edge_shape = shape;
            RendererState& state = prepared(s);
            const auto values = scaled_field(s.volume);
            const reference::Field field{s.volume.geometry.dims, values, {}};
            const reference::ScaledScene scaled = s.scaled();
            const auto field_edges = device_field(state);
            auto want = reference::smooth_edges(field, scaled, s.settings, field_edges);
            const auto classified = reference::classified_values(field, scaled, field_edges);
            reference::weigh_by_edge(s.settings,
                                     reference::edge_contrasts(field, scaled, s.scene, field_edges, classified), want);
            double low = 1, worst = 0;
            std::size_t differ = 0;
            const auto records = device_records(state);
            for (const auto& record : records) {
                low = std::min(low, record.edge.weight);
                const double off = std::abs(record.edge.weight - want[record.voxel].weight);
                worst = std::max(worst, off);
                // Two steps of D and two of D2, 4e-3 of a voxel, at a slope of 1.7 per voxel. Neighbours at the limits
                // of smoothing may be counted on one side and not on the other.
                differ += off > 2e-2 ? 1U : 0U;
            }
            // Walls of up to 2.5 voxels are left alone.
            EXPECT_EQ(low < 0.9, s.name != "wall from inside") << "least " << low;
            EXPECT_LE(differ, records.size() / 500) << "worst " << worst;
        }
    }
}

TEST(CollectSplats, EdgesOnBothSidesAreEstimatedForWeightsAndOnlyThen) {
    PassScene s = pass_scenes()[0];
    const auto with_edges = [&] {
        std::size_t count = 0;
        for (const auto& edge : device_field(prepared(s)))
            count += edge.has_edge ? 1U : 0U;
        return count;
    };
    const std::size_t visible = with_edges();
    s.settings.normalisation = Normalisation::Voxel;
    EXPECT_GT(with_edges(), visible + visible / 2);
}

TEST(CollectSplats, AVolumeWithoutVisibleVoxelsGivesAnEmptyListAndTheBackground) {
    PassScene s = pass_scenes()[0];
    s.scene.iso_values = {2.0};
    RendererState& state = prepared(s);
    EXPECT_EQ(state.volume_resources.splat_count, 0U);
    s.scene.background = {0.25, 0.5, 0.125};
    state.draw(s.scene, s.camera, s.settings, {16, 8}, shader::PAYLOAD_COLOR);
    for (const auto& pixel : state.targets.output.mapped<glm::vec4>(128))
        EXPECT_EQ(pixel, glm::vec4(0.25F, 0.5F, 0.125F, 0.0F));
}

}  // namespace
}  // namespace edgesplat::test

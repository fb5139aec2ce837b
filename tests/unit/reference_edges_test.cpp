// Pass 1 on volumes with known edges.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/reference/1_estimate_edges.h"
#include "engine/volume/filters.h"
#include "footprints/kernel.h"
#include "tests/unit/reference_volumes.h"

namespace edgesplat::reference {
namespace {

using namespace testing_volumes;

/// A volume in which both materials are visible, prepared for edge estimation.
struct Case {
    Volume volume;
    Scene scene = solid_scene(1);
    std::vector<float> values, coefficients;

    explicit Case(Volume v) : volume(std::move(v)) {
        scene.materials[0].extinction = 1;
        values = scaled_field(volume);
        coefficients = bspline_coefficients(values, volume.geometry.dims);
    }
    Field field() const { return {volume.geometry.dims, values, coefficients}; }
    std::vector<VoxelEdge> edges(EdgeEstimator estimator, bool quantised = false) const {
        Settings settings;
        settings.edges = estimator;
        const ScaledScene scaled = scale_scene(scene, volume);
        return finish_edges(field(), scaled, settings, estimate_edges(field(), scaled, settings, quantised));
    }
};

/// Root mean square error of D over voxels within R of the edge and at least 4 from the border; all must have an edge.
template <typename Distance>
double rms_error(const Case& c, EdgeEstimator estimator, const Distance& signed_distance) {
    const std::vector<VoxelEdge> edges = c.edges(estimator);
    double squares = 0;
    double count = 0;
    for (std::size_t at = 0; at < edges.size(); ++at) {
        const glm::ivec3 i = c.field().voxel(at);
        const double truth = signed_distance(glm::dvec3(i));
        if (i != glm::clamp(i, glm::ivec3(4), c.volume.geometry.dims - 5) || !(std::abs(truth) < kKernelRadius)) {
            continue;
        }
        EXPECT_TRUE(edges[at].has_edge) << i.x << ' ' << i.y << ' ' << i.z;
        const double found = edges[at].upper ? edges[at].D : -edges[at].D;
        squares += (found - truth) * (found - truth);
        ++count;
    }
    EXPECT_GT(count, 100);
    return std::sqrt(squares / count);
}

TEST(EstimateEdges, MarchFindsBlurredPlanes) {
    for (const glm::dvec3 n : {glm::dvec3(1, 0, 0), glm::dvec3(1, 1, 0), glm::dvec3(1, 2, 3), glm::dvec3(-3, 1, 2)}) {
        const auto distance = [&](const glm::dvec3& x) { return glm::dot(glm::normalize(n), x - glm::dvec3(8.3)); };
        const Case c(sampled(glm::ivec3(18), [&](const glm::dvec3& x) { return blurred(distance(x)); }));
        EXPECT_LT(rms_error(c, EdgeEstimator::March, distance), 0.03);
        EXPECT_LT(rms_error(c, EdgeEstimator::Cubic, distance), 0.02);
    }
}

TEST(EstimateEdges, MarchFindsBlurredSpheres) {
    const Case c(ball(28, 9));
    const auto distance = [](const glm::dvec3& x) { return glm::length(x - glm::dvec3(13.5)) - 9; };
    EXPECT_LT(rms_error(c, EdgeEstimator::March, distance), 0.03);
    EXPECT_LT(rms_error(c, EdgeEstimator::Cubic, distance), 0.02);
}

TEST(EstimateEdges, LinearRampIsExact) {
    const glm::dvec3 n = glm::normalize(glm::dvec3(2, -1, 3));
    // Scaling by the ramp's range does not move the plane of the iso-value.
    const auto ramp = [&](const glm::dvec3& x) { return 0.5 - 0.02 * glm::dot(n, x - glm::dvec3(7.2)); };
    const Case c(sampled(glm::ivec3(16), ramp));
    for (const auto estimator : {EdgeEstimator::Taylor, EdgeEstimator::March, EdgeEstimator::Cubic}) {
        const double tolerance = 2e-5;
        const auto edges = c.edges(estimator);
        int checked = 0;
        for (std::size_t at = 0; at < edges.size(); ++at) {
            const glm::ivec3 i = c.field().voxel(at);
            const double truth = glm::dot(n, glm::dvec3(i) - glm::dvec3(7.2));
            if (i != glm::clamp(i, glm::ivec3(4), glm::ivec3(11)) || std::abs(truth) > 1.5) continue;
            ASSERT_TRUE(edges[at].has_edge);
            EXPECT_NEAR(edges[at].D, std::abs(truth), tolerance) << name_of(estimator);
            EXPECT_EQ(edges[at].upper, truth > 0);
            EXPECT_NEAR(glm::dot(edges[at].n, truth > 0 ? -n : n), 1, tolerance);
            ++checked;
        }
        EXPECT_GT(checked, 50);
    }
}

TEST(EstimateEdges, NormalsOfBlurredPlanesAreWithinADegree) {
    const glm::dvec3 n = glm::normalize(glm::dvec3(1, 2, 3));
    const Case c(
        sampled(glm::ivec3(18), [&](const glm::dvec3& x) { return blurred(glm::dot(n, x - glm::dvec3(8.3))); }));
    const auto edges = c.edges(EdgeEstimator::March);
    for (std::size_t at = 0; at < edges.size(); ++at) {
        const glm::ivec3 i = c.field().voxel(at);
        if (i != glm::clamp(i, glm::ivec3(4), glm::ivec3(13)) || !edges[at].has_edge) continue;
        EXPECT_GT(std::abs(glm::dot(edges[at].n, n)), std::cos(glm::radians(1.0)));
    }
}

TEST(EstimateEdges, FindsBothFacesOfWalls) {
    const glm::dvec3 n = glm::normalize(glm::dvec3(1, 2, 2));
    const auto wall = [&](const glm::dvec3& x) {
        const double s = glm::dot(n, x - glm::dvec3(9.4));
        return blurred(s - 1.25) - blurred(s + 1.25);
    };
    const Case c(sampled(glm::ivec3(20), wall));
    const auto edges = c.edges(EdgeEstimator::March);
    int walls = 0;
    for (std::size_t at = 0; at < edges.size(); ++at) {
        const glm::ivec3 i = c.field().voxel(at);
        if (i != glm::clamp(i, glm::ivec3(4), glm::ivec3(15)) || !(c.values[at] >= 0.5F)) continue;
        ASSERT_TRUE(edges[at].has_edge);
        // One quadric may contain both faces: along n its slope is 0 in the middle.
        const double bend = glm::dot(edges[at].n, edges[at].bending * edges[at].n);
        const bool apart = std::isfinite(edges[at].D2);
        EXPECT_NEAR(apart ? edges[at].D + edges[at].D2 : 2 / bend, 2.5, 0.3);
        ++walls;
    }
    EXPECT_GT(walls, 100);
}

TEST(EstimateEdges, FindsNoEdgeInFlatData) {
    const Case c(sampled(glm::ivec3(5), [](const glm::dvec3&) { return 3.0; }));
    for (const auto estimator :
         {EdgeEstimator::Off, EdgeEstimator::Taylor, EdgeEstimator::March, EdgeEstimator::Cubic}) {
        for (const VoxelEdge& edge : c.edges(estimator))
            EXPECT_TRUE(!edge.has_edge || edge.D == 0.5 || edge.D == 1.5) << "only the volume's border is an edge";
    }
}

TEST(EstimateEdges, HandlesVolumesOneVoxelThick) {
    const Case c(sampled(glm::ivec3(9, 7, 1), [](const glm::dvec3& x) { return blurred(x.x - 4.2); }));
    for (const auto estimator : {EdgeEstimator::Taylor, EdgeEstimator::March, EdgeEstimator::Cubic}) {
        const VoxelEdge edge = c.edges(estimator)[3 * 9 + 4];
        EXPECT_TRUE(edge.has_edge);
        EXPECT_NEAR(edge.D, 0.2, estimator == EdgeEstimator::Taylor ? 0.25 : 0.08);
        EXPECT_NEAR(edge.n.x, 1, 1e-6);
    }
}

TEST(EstimateEdges, StoredBitsKeepPrecision) {
    const Case c(ball(20, 6));
    const auto exact = c.edges(EdgeEstimator::March);
    const auto stored = c.edges(EdgeEstimator::March, true);
    int edges = 0;
    for (std::size_t at = 0; at < exact.size(); ++at) {
        // Rounding may move an edge across the limit.
        if (!exact[at].has_edge || exact[at].D > edge_reach({}) - 0.01) continue;
        ASSERT_TRUE(stored[at].has_edge);
        EXPECT_NEAR(stored[at].D, exact[at].D, 1e-4);
        EXPECT_GT(glm::dot(stored[at].n, exact[at].n), 1 - 1e-8);
        if (std::isfinite(exact[at].D2) && exact[at].D2 < 7.9) {
            EXPECT_NEAR(stored[at].D2, exact[at].D2, 0.004);
        }
        ++edges;
    }
    EXPECT_GT(edges, 500);
}

}  // namespace
}  // namespace edgesplat::reference

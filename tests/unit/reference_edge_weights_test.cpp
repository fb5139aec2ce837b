// What one side of a plane draws, with and without weights by the distance to it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/glm.hpp>
#include <random>

#include "engine/reference/footprints.h"
#include "footprints/edge_weight.h"

namespace edgesplat::reference {
namespace {

double uniform(std::mt19937& random) {
    return random() / 4294967296.0;
}

glm::dvec3 in_cube(std::mt19937& random) {
    const double x = uniform(random), y = uniform(random), z = uniform(random);
    return glm::dvec3(x, y, z) - 0.5;
}

struct Excess {
    double mean = 0, rms = 0, largest = 0;
};

/// Of slabs whose edges are known exactly: by how much more their kernels weigh along a ray than it passes through, in
/// voxels of thickness.
Excess excess(const Settings& settings, double thickness, bool along_lattice, const EdgeWeights* weights) {
    const Footprints footprints(settings);
    const EdgeBand band{settings.edge_half_width, settings.edge_strength};
    std::mt19937 random(5);
    Excess result;
    constexpr int kRays = 200, kReach = 10;
    for (int ray = 0; ray < kRays; ++ray) {
        const glm::dvec3 n = along_lattice ? glm::dvec3(0, 0, 1) : glm::normalize(in_cube(random));
        const glm::dvec3 u = glm::normalize(n + in_cube(random)), centre = in_cube(random);
        double sum = 0;
        for (int z = -kReach; z <= kReach; ++z) {
            for (int y = -kReach; y <= kReach; ++y) {
                for (int x = -kReach; x <= kReach; ++x) {
                    const glm::dvec3 voxel(x, y, z);
                    const double t = glm::dot(voxel - centre, n);
                    const glm::dvec3 p = centre - voxel - glm::dot(centre - voxel, u) * u;
                    if (std::abs(t) >= thickness / 2 || glm::dot(p, p) > 16) continue;
                    VoxelEdge edge;
                    edge.n = t > 0 ? n : -n;
                    edge.D = thickness / 2 - std::abs(t);
                    edge.D2 = thickness - edge.D < 4 ? thickness - edge.D : edge.D2;
                    edge.has_edge = edge.has_normal = true;
                    if (weights != nullptr) edge.weight = edge_weight(edge.D, edge.D2, band, *weights);
                    sum += footprints.along_ray(edge, p, u);
                }
            }
        }
        const double e = sum * std::abs(glm::dot(u, n)) - thickness;
        result.mean += e / kRays;
        result.rms += e * e / kRays;
        result.largest = std::max(result.largest, std::abs(e));
    }
    result.rms = std::sqrt(result.rms);
    return result;
}

TEST(EdgeWeights, RunFromNearlyNothingToOneAndAreTheSameOnEveryCall) {
    const EdgeBand band;
    const EdgeWeights weights = edge_weights(band);
    EXPECT_EQ(weights, edge_weights(band));
    EXPECT_LT(weights.front(), 0.15);
    EXPECT_EQ(weights.back(), 1);
    for (const double weight : weights)
        EXPECT_LT(weight, 1.05);
    EXPECT_EQ(edge_weight(-0.4, weights), weights.front());
    EXPECT_EQ(edge_weight(kEdgeWeightReach, weights), 1);
    EXPECT_EQ(edge_weight(1e9, weights), 1);
    EXPECT_NEAR(edge_weight(0.1, weights), (weights[0] + weights[1]) / 2, 1e-12);
    EXPECT_EQ(edge_weight(1, 1.4, band, weights), 1) << "thin walls";
    EXPECT_DOUBLE_EQ(edge_weight(1, 2.2, band, weights), edge_weight(1, weights) * edge_weight(2.2, weights));
}

TEST(EdgeWeights, ASlabDrawsItsVolumeHoweverItLiesInTheLattice) {
    for (const double strength : {4.0, 16.0, 64.0}) {
        Settings settings;
        settings.edge_strength = strength;
        const EdgeWeights weights = edge_weights({settings.edge_half_width, strength});
        for (const bool lattice : {false, true}) {
            const Excess plain = excess(settings, 6.45, lattice, nullptr);
            const Excess weighted = excess(settings, 6.45, lattice, &weights);
            std::printf("k %2.0f %-8s thickness off by %.4f rms, %.4f at most; weighted %.4f, %.4f\n", strength,
                        lattice ? "(001)" : "random", plain.rms, plain.largest, weighted.rms, weighted.largest);
            // What is left of a strength of 64 is the footprints' own error, of 10 nodes a half band.
            EXPECT_LT(weighted.rms, strength < 64 ? 0.35 * plain.rms : 0.006);
            EXPECT_LT(weighted.largest, strength < 64 ? 0.5 * plain.largest : 0.015);
        }
    }
}

TEST(EdgeWeights, WallsAreNoThickerThanWithoutThem) {
    Settings settings;
    const EdgeWeights weights = edge_weights({settings.edge_half_width, settings.edge_strength});
    for (const double thickness : {1.5, 2.0, 2.75, 3.0, 3.5, 4.0, 5.0}) {
        const Excess plain = excess(settings, thickness, false, nullptr);
        const Excess weighted = excess(settings, thickness, false, &weights);
        std::printf("wall of %.2f: thickness off by %.4f rms, %.4f at most; weighted %.4f, %.4f\n", thickness,
                    plain.rms, plain.largest, weighted.rms, weighted.largest);
        EXPECT_LT(weighted.rms, 1.3 * plain.rms);
        EXPECT_LT(weighted.largest, 1.1 * plain.largest);
    }
}

}  // namespace
}  // namespace edgesplat::reference

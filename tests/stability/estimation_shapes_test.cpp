// Pass 1 with difficult shapes: no gradient, walls and edges closer than a voxel, borders, grids that are not cubic,
// volumes of a few voxels and of very many.
#include <algorithm>
#include <cmath>

#include "engine/reference/3_select_footprints.h"
#include "footprints/kernel.h"
#include "tests/stability/hazard.h"

namespace edgesplat::test {
namespace {

constexpr double kEnd = 0.5;  // a body extends half a voxel beyond its last sample

TEST(EstimationShapes, NoGradientAtTheIsoValue) {
    // A cubic with slope 0 where it crosses the iso-value: beside it there is no direction, but a voxel away there is.
    const double edge = 10.3;
    const auto flat = volume_of({21, 12, 12}, [&](const glm::ivec3& v) {
        return static_cast<float>(0.5 + 0.5 * std::pow((v.x - edge) / 10.7, 3));
    });
    expect_as_reference(shot_of(flat), "an inflection");
    const Estimate e = estimate(flat, {0.5}, EdgeEstimator::March);
    EXPECT_FALSE(e.at({10, 6, 6}).has_edge && std::abs(e.at({10, 6, 6}).D) > 1) << "the edge is invented";
    const Middle thick = thickness_along_x(shot_of(flat));
    // Even a voxel away the value differs only by a thousandth: no position is wrong.
    EXPECT_NEAR(thick.mean, 20 + kEnd - edge, 1.25);
    EXPECT_LE(thick.most - thick.least, 0.02);
}

/// Rises to 0.5 at x = 8, is constant up to 14, and rises again.
VolumePointer plateau() {
    return volume_of({24, 12, 12}, [](const glm::ivec3& v) {
        if (v.x <= 8) return static_cast<float>(std::max(0.0, 0.5 - (8 - v.x) * 0.125));
        return v.x <= 14 ? 0.5F : static_cast<float>(std::min(1.0, 0.5 + (v.x - 14) * 0.125));
    });
}

TEST(EstimationShapes, PlateauOnTheIsoValueBelongsAbove) {
    expect_as_reference(shot_of(plateau()), "a plateau");
    EXPECT_NEAR(thickness_along_x(shot_of(plateau())).mean, 23 + kEnd - 8, 0.6);
}

TEST(EstimationShapes, PlateauJustBelowTheIsoValueBelongsBelow) {
    const double just_above = 0.5 + 1e-4;
    expect_as_reference(shot_of(plateau(), just_above), "a plateau");
    EXPECT_NEAR(thickness_along_x(shot_of(plateau(), just_above)).mean, 23 + kEnd - 14, 0.6);
}

TEST(EstimationShapes, PeakJustBelowTheIsoValue) {
    // A ridge whose parabola ends just below the iso-value; only one corner exceeds it.
    const auto ridge = volume_of({20, 12, 12}, [](const glm::ivec3& v) {
        if (v == glm::ivec3(19, 11, 11)) return 1.0F;
        return static_cast<float>(std::max(0.7 - 0.03 * std::pow(v.x - 9.3, 2), 0.0));
    });
    Shot shot = shot_of(ridge, 0.705);
    shot.scene.materials[0].extinction = 0.1;  // so that the ridge's own side is estimated
    expect_as_reference(shot, "a peak", 0.003, 55);
    for (const EdgeEstimator estimator : {EdgeEstimator::March, EdgeEstimator::Cubic}) {
        const Estimate e = estimate(ridge, {0.705}, estimator);
        EXPECT_FALSE(e.at({9, 6, 6}).has_edge) << name_of(estimator) << ": there is no crossing";
    }
}

TEST(EstimationShapes, SaddleOnTheIsoValue) {
    const glm::dvec2 c(9.5, 9.5);
    const auto saddle = volume_of({20, 20, 12}, [&](const glm::ivec3& v) {
        const double x = v.x - c.x, y = v.y - c.y;
        return static_cast<float>(0.5 + 0.005 * (x * x - y * y));
    });
    expect_as_reference(shot_of(saddle), "a saddle");
    const Estimate e = estimate(saddle, {0.5}, EdgeEstimator::March);
    for (int x = 3; x < 17; ++x) {
        for (int y = 3; y < 17; ++y) {
            const auto& voxel = e.at({x, y, 6});
            const double away = std::abs(std::abs(x - c.x) - std::abs(y - c.y)) / std::sqrt(2.0);
            const double from_centre = std::hypot(x - c.x, y - c.y);
            if (!voxel.has_edge || from_centre < 3 || away > 1.5) continue;
            EXPECT_NEAR(std::abs(voxel.D), away, 0.12) << x << ", " << y;
        }
    }
}

TEST(EstimationShapes, SaddleWhereEightVoxelsMeet) {
    const auto corner = volume_of({12, 12, 12}, [](const glm::ivec3& v) {
        return (static_cast<int>(v.x > 5) + static_cast<int>(v.y > 5) + static_cast<int>(v.z > 5)) % 2 == 0 ? 0.0F
                                                                                                            : 1.0F;
    });
    Shot shot = shot_of(corner);
    expect_as_reference(shot, "eight octants", 0.06);
    // Each line crosses one full octant. A kernel has one plane: where planes cross, matter is lost, here a third, and
    // little is invented.
    const Middle warped = thickness_along_x(shot);
    EXPECT_LE(warped.most, 6.3);
    EXPECT_GE(warped.mean, 3.4);
    shot.settings.edges = EdgeEstimator::Off;
    EXPECT_NEAR(thickness_along_x(shot).mean, 6, 0.01) << "plain kernels lose no matter";
}

/// A wall perpendicular to x with a linear profile of slope 1/2 per voxel: it reaches iso 0.5 exactly at centre +-
/// thickness / 2.
VolumePointer wall(double thickness, double centre) {
    return volume_of({20, 14, 14}, [=](const glm::ivec3& v) {
        return static_cast<float>(std::clamp(0.5 + (thickness / 2 - std::abs(v.x - centre)) / 2, 0.0, 1.0));
    });
}

/// Thin walls are drawn with their thickness, walls below a voxel at most one voxel thick, and without holes.
void expect_wall(double thickness, double within) {
    for (const double shift : {0.0, 0.13, 0.24}) {
        const auto volume = wall(thickness, 9 + shift);
        // For a voxel exactly in the middle, rounding decides which of the two faces is its nearest; both are right.
        expect_as_reference(shot_of(volume), fmt::format("a wall of {} at {}", thickness, shift), 0.003);
        const Middle thick = thickness_along_x(shot_of(volume));
        EXPECT_GE(thick.mean, thickness - within) << shift;
        // The density is right in the mean over lattices: with voxels exactly in its middle, a wall of one voxel has a
        // fifth more.
        EXPECT_LE(thick.mean, std::max(thickness, 1.0) + (thickness > 1 ? within : 0.3)) << shift;
        EXPECT_LE(thick.most - thick.least, 0.06) << shift << ": uneven from voxel to voxel";
    }
}

TEST(EstimationShapes, WallOfHalfAVoxel) {
    expect_wall(0.5, 0.25);
}
TEST(EstimationShapes, WallOfOneVoxel) {
    expect_wall(1, 0.15);
}
TEST(EstimationShapes, WallOfOneAndAHalfVoxels) {
    expect_wall(1.5, 0.6);
}
TEST(EstimationShapes, WallOfTwoVoxels) {
    expect_wall(2, 0.6);
}

TEST(EstimationShapes, TwoEdgesCloserThanAVoxel) {
    const auto ramp = volume_of({20, 14, 14}, [](const glm::ivec3& v) {
        return static_cast<float>(std::clamp(0.5 + (v.x - 9.4) * 0.5, 0.0, 1.0));
    });
    Shot shot = shot_of(ramp);
    shot.scene.iso_values = {0.45, 0.55};
    shot.scene.materials = {{}, {{0.2, 0.4, 1}, 0.5}, {{1, 0.8, 0.6}, 2}};
    expect_as_reference(shot, "two edges 0.2 voxels apart");
    shot.scene.materials[1] = shot.scene.materials[2];
    EXPECT_NEAR(thickness_along_x(shot).mean, 19 + kEnd - 9.3, 0.3) << "with one material only the first edge counts";
}

TEST(EstimationShapes, FifteenEdgesInOneVoxel) {
    const auto step = volume_of({16, 12, 12}, [](const glm::ivec3& v) { return v.x < 8 ? 0.0F : 1.0F; });
    Shot shot = shot_of(step);
    shot.scene.iso_values.clear();
    shot.scene.materials = {{}};
    for (int i = 1; i <= 15; ++i) {
        shot.scene.iso_values.push_back(i / 16.0);
        shot.scene.materials.push_back({{1, 1, 1}, 2});
    }
    expect_as_reference(shot, "15 iso-values in a step", 0.03);
    EXPECT_NEAR(thickness_along_x(shot).mean, 8, 0.6);
}

TEST(EstimationShapes, EdgeOnAVoxelIsContinuous) {
    const auto ramp = [](double edge) {
        return volume_of({20, 14, 14}, [=](const glm::ivec3& v) {
            return static_cast<float>(std::clamp(0.5 + (v.x - edge) * 0.25, 0.0, 1.0));
        });
    };
    const auto on = ramp(9);
    const Estimate e = estimate(on, {0.5}, EdgeEstimator::March);
    ASSERT_TRUE(e.at({9, 7, 7}).has_edge);
    EXPECT_NEAR(e.at({9, 7, 7}).D, 0, 1e-3);
    expect_as_reference(shot_of(on), "an edge on a voxel");
    // The voxel on the edge changes sides between these two; the picture must hardly change.
    const double before = thickness_along_x(shot_of(ramp(9 - 1e-5))).mean;
    const double after = thickness_along_x(shot_of(ramp(9 + 1e-5))).mean;
    EXPECT_NEAR(before, after, 0.15);
    EXPECT_NEAR((before + after) / 2, 19 + kEnd - 9, 0.15);
}

TEST(EstimationShapes, EdgesOnAndBeyondTheBorder) {
    for (const double edge : {0.0, 0.3, 0.5, 18.7, 19.0}) {
        const auto ramp =
            volume_of({20, 14, 14}, [=](const glm::ivec3& v) { return static_cast<float>(0.5 + (v.x - edge) * 0.02); });
        expect_as_reference(shot_of(ramp), fmt::format("an edge at {}", edge));
        EXPECT_NEAR(thickness_along_x(shot_of(ramp)).mean, 19 + kEnd - edge, 0.6) << edge;
    }
}

/// Edges do not depend on the directions of the grid's axes: planes are estimated in index space.
void expect_same_edges(const glm::dmat3& axes) {
    const auto still = std::make_shared<const Volume>(sample(torus_scene({26, 24, 18}, {12.3, 11.6, 8.4}, 6.4, 3.3)));
    for (const EdgeEstimator estimator : {EdgeEstimator::March, EdgeEstimator::Cubic}) {
        const Estimate want = estimate(still, {0.5}, estimator), got = estimate(placed(still, axes), {0.5}, estimator);
        ASSERT_EQ(want.device.size(), got.device.size());
        EXPECT_GT(want.edges(), 1000U);
        std::size_t differ = 0;
        for (std::size_t i = 0; i < want.device.size(); ++i)
            differ += want.device[i].D != got.device[i].D || want.device[i].n != got.device[i].n ? 1U : 0U;
        EXPECT_EQ(differ, 0U) << name_of(estimator);
    }
    Shot shot = shot_of(placed(still, axes));
    EXPECT_GE(against_reference(shot, "the torus on other axes").psnr, 60);
}

TEST(EstimationShapes, SpacingOf1To1To100) {
    expect_same_edges(glm::dmat3(1, 0, 0, 0, 1, 0, 0, 0, 100));
}
TEST(EstimationShapes, ObliqueAxes) {
    expect_same_edges(glm::dmat3(glm::dvec3(0.9, 0.2, 0.1), glm::dvec3(0.2, 1.1, 0.15), glm::dvec3(0.1, 0.3, 1.7)));
}
TEST(EstimationShapes, LeftHandedAxes) {
    expect_same_edges(glm::dmat3(-1, 0, 0, 0, 1, 0, 0, 0, 1));
}
TEST(EstimationShapes, NearlyFlatAxes) {
    // Two axes 0.6 degrees apart.
    expect_same_edges(glm::dmat3(glm::dvec3(1, 0, 0), glm::dvec3(0.99995, 0.01, 0), glm::dvec3(0, 0, 1)));
}

/// Normals of a linear field are its gradient, up to the border.
TEST(EstimationShapes, LinearFieldsHaveOneNormalUpToTheBorder) {
    for (const glm::dvec3 slope : {glm::dvec3(0.6, 0.3, 0.1), glm::dvec3(-0.2, 0.1, 0.5), glm::dvec3(0.1, -0.7, 0.2)}) {
        const glm::dvec3 middle(5.8, 6.1, 5.4);
        const auto ramp = volume_of({12, 13, 11}, [&](const glm::ivec3& v) {
            return static_cast<float>(0.5 + 0.02 * glm::dot(slope, glm::dvec3(v) - middle));
        });
        const Estimate e = estimate(ramp, {0.5}, EdgeEstimator::March);
        int at_border = 0;
        for (std::size_t i = 0; i < e.device.size(); ++i) {
            const auto n = static_cast<int>(i);
            const glm::ivec3 v(n % 12, n / 12 % 13, n / 12 / 13);
            const reference::VoxelEdge& edge = e.device[i];
            if (!edge.has_edge || edge.border) continue;
            const bool outermost = glm::any(glm::equal(v, glm::ivec3(0))) || glm::any(glm::equal(v, e.dims - 1));
            at_border += outermost ? 1 : 0;
            const glm::dvec3 up = (edge.upper ? 1.0 : -1.0) * glm::normalize(slope);
            EXPECT_LE(glm::length(edge.n - up), 2e-3) << v.x << ", " << v.y << ", " << v.z;
            // The field is constant from the outermost samples to the border, half a voxel away.
            if (outermost) continue;
            EXPECT_NEAR(edge.D, -glm::dot(glm::dvec3(v) - middle, up), 2e-3) << v.x << ", " << v.y << ", " << v.z;
        }
        EXPECT_GT(at_border, 20);
    }
}

/// All of one voxel's matter is in its cube; six cuts of one kernel lose a ninth of it.
TEST(EstimationShapes, OneVoxelIsACube) {
    const auto one = volume_of({1, 1, 1}, [](const glm::ivec3&) { return 1.0F; });
    Shot shot = shot_of(one, 0.5, 0.2);
    const double distance = 200, across = 4;
    shot.width = shot.height = 40;
    for (const glm::dvec3 from : {glm::dvec3(-1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(-1, 1, -1)}) {
        const glm::dvec3 away = glm::normalize(from);
        shot.camera = look(*one, distance * away, {0, 0, 0}, 2 * glm::degrees(std::atan(across / 2 / distance)));
        const Image tau = *sound(shot, "one voxel").tau;
        const reference::View view(shot.camera, one->geometry, 40, 40);
        double sum = 0;
        for (int y = 0; y < 40; ++y)
            for (int x = 0; x < 40; ++x) {
                const auto inside = reference::piece_in_volume({1, 1, 1}, view.eye_index, view.ray(x, y));
                const auto here = static_cast<double>(tau.at(x, y, 0));
                if (!(inside.low < inside.high)) {
                    EXPECT_EQ(here, 0) << x << ", " << y;
                }
                sum += here * (across / 40) * (across / 40);
            }
        EXPECT_NEAR(sum, 0.2, 0.025) << "the amount of matter";
    }
}

TEST(EstimationShapes, OneVoxelIsItsKernel) {
    const auto one = volume_of({1, 1, 1}, [](const glm::ivec3&) { return 1.0F; });
    for (const double distance : {3.0, 100.0}) {
        Shot shot = shot_of(one, 0.5, 0.7);
        shot.settings.edges = EdgeEstimator::Off;
        shot.camera = look(*one, {-distance, 0, 0}, {0, 0, 0}, 2 * glm::degrees(std::atan(2.0 / distance)));
        shot.width = shot.height = 33;
        const Image tau = *sound(shot, "one voxel").tau;
        for (int x = 0; x < 33; ++x) {
            // The ray through pixel (x, 16) passes the voxel at this distance.
            const double slope = (x - 16) * (2.0 / distance) / 16.5;
            const double rho2 = std::pow(distance * slope, 2) / (1 + slope * slope);
            EXPECT_NEAR(static_cast<double>(tau.at(x, 16, 0)), 0.7 * kernel_footprint(rho2), 2e-6) << x;
        }
    }
}

/// A block of ones absorbs according to the ray's chord in it; along an axis of one voxel, according to the sum of its
/// kernels.
void expect_block(const glm::ivec3& dims) {
    const auto block = volume_of(dims, [](const glm::ivec3&) { return 1.0F; });
    Shot shot = shot_of(block);
    const reference::View view(shot.camera, block->geometry, shot.width, shot.height);
    const Image tau = *sound(shot, "a block").tau;
    int met = 0;
    for (int y = 1; y < shot.height; y += 3) {
        for (int x = 1; x < shot.width; x += 3) {
            const glm::dvec3 u = view.ray(x, y);
            const reference::VolumePiece inside = reference::piece_in_volume(dims, view.eye_index, u);
            const auto got = static_cast<double>(tau.at(x, y, 0));
            if (!(inside.low < inside.high)) {
                EXPECT_EQ(got, 0) << x << ", " << y;
                continue;
            }
            // Kernels of the outermost voxels have a larger weight, which keeps the amount of matter: with two voxels a
            // third more in the middle, less where faces meet.
            const double want = 2 * (inside.high - inside.low);
            EXPECT_LE(got, 1.3 * want + 0.1) << x << ", " << y;
            const bool in_the_middle = x / 3 == shot.width / 6 && y / 3 == shot.height / 6;
            if (in_the_middle) {
                EXPECT_NEAR(got, want, 0.35 * want);
            }
            ++met;
        }
    }
    EXPECT_GT(met, 0);
    expect_as_reference(shot, "a block");
}

TEST(EstimationShapes, TwoByTwoByTwo) {
    expect_block({2, 2, 2});
}
TEST(EstimationShapes, OneVoxelThickAlongX) {
    expect_block({1, 9, 7});
}
TEST(EstimationShapes, OneVoxelThickAlongY) {
    expect_block({9, 1, 7});
}
TEST(EstimationShapes, OneVoxelThickAlongZ) {
    expect_block({9, 7, 1});
}
TEST(EstimationShapes, LineOfVoxels) {
    expect_block({1, 1, 40});
    expect_block({40, 1, 1});
}

TEST(EstimationShapes, OneVoxelThickVolumesHaveEdgesInTheirPlane) {
    const auto sheet = volume_of({24, 20, 1}, [](const glm::ivec3& v) {
        return static_cast<float>(std::clamp(0.5 + (6 - std::hypot(v.x - 11.4, v.y - 9.7)) * 0.4, 0.0, 1.0));
    });
    for (const EdgeEstimator estimator : kEstimators) {
        const Estimate e = estimate(sheet, {0.5}, estimator);
        EXPECT_GT(e.edges(), 30U) << name_of(estimator);
        for (const auto& edge : e.device)
            EXPECT_TRUE(edge.border || std::abs(edge.n.z) <= 1e-3) << name_of(estimator);
    }
    expect_as_reference(shot_of(sheet), "a disc");
}

TEST(EstimationShapes, LastVoxelOfALargeVolume) {
    // 2^25 voxels: float32 cannot represent all indices. A ball in the last corner must look as it does alone.
    const glm::ivec3 dims(256, 256, 512), corner = dims - 20;
    const auto value = [](const glm::ivec3& v) {
        return static_cast<float>(
            std::clamp(0.5 + (5.3 - glm::length(glm::dvec3(v) - glm::dvec3(9.4, 9.7, 9.5))), 0.0, 1.0));
    };
    const auto alone = volume_of({20, 20, 20}, value);
    auto large = std::make_shared<Volume>();
    large->geometry.dims = dims;
    large->geometry.origin = -glm::dvec3(corner);
    large->values.assign(large->geometry.voxel_count(), 0.0F);
    for (int z = 0; z < 20; ++z)
        for (int y = 0; y < 20; ++y)
            for (int x = 0; x < 20; ++x) {
                const auto at =
                    (static_cast<std::size_t>(corner.z + z) * 256 + static_cast<std::size_t>(corner.y + y)) * 256 +
                    static_cast<std::size_t>(corner.x + x);
                large->values[at] = value({x, y, z});
            }
    finish_volume(*large);
    Shot shot = shot_of(alone);
    const Image want = render(shot).color;
    shot.volume = large;
    const Image got = render(shot).color;
    EXPECT_GE(compare_images(want, got).psnr, 80);
    EXPECT_GT(middle_of(got, 3).most, 0.9);
}

}  // namespace
}  // namespace edgesplat::test

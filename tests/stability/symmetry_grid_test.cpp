// The same object gives the same picture in every representation: mirrored, rotated, with other orders of axes, other
// units, other values.
#include <algorithm>
#include <cmath>

#include "tests/stability/hazard.h"

namespace edgesplat::test {
namespace {

/// An asymmetric, dented body in 18 x 15 x 12 voxels of 1 x 1.1 x 1.3 mm, with two materials and a light.
Shot uneven() {
    static const VolumePointer volume = volume_of(
        {18, 15, 12},
        [](const glm::ivec3& v) {
            const double x = (v.x - 8.2) / 6.1, y = (v.y - 6.9) / 4.7, z = (v.z - 5.3) / 3.9;
            const double body = 1 - std::sqrt(x * x + y * y + z * z + 0.3 * x * y * y - 0.2 * z * x);
            return static_cast<float>(std::clamp(0.5 + 1.6 * body, 0.0, 1.0));
        },
        glm::dmat3(1, 0, 0, 0, 1.1, 0, 0, 0, 1.3));
    Shot shot = shot_of(volume);
    shot.scene.iso_values = {0.35, 0.8};
    shot.scene.materials = {{}, {{0.2, 0.5, 1}, 0.15}, {{1, 0.85, 0.7}, 3}};
    shot.scene.lights = {directional_light({0.4, -1, 0.6})};
    shot.camera = look(*volume, {20, -22, 24}, {8.5, 7, 5.5}, 28);
    shot.width = shot.height = 40;
    return shot;
}

/// Bounds for single precision and for the few voxels half-way between two planes.
void expect_alike(const Image& a, const Image& b, const std::string& what) {
    const ImageDifference difference = compare_images(a, b, 2e-3);
    EXPECT_GT(middle_of(a, 3).most, 0.9) << what << ": the picture is empty";
    EXPECT_LE(difference.share, 0.01) << what << ": largest " << difference.max;
    EXPECT_LE(difference.max, 0.03) << what;
    EXPECT_GE(difference.psnr, 60) << what;
}

/// The samples stored in another order, at the same positions: axis i of the new grid is axis `order[i]` of the old
/// one, reversed if `reversed[i]`.
Shot restored(Shot shot, const glm::ivec3& order, const glm::bvec3& reversed = glm::bvec3(false)) {
    const Volume& old = *shot.volume;
    const auto stored = std::make_shared<Volume>();
    VolumeGeometry& g = stored->geometry;
    g.origin = old.geometry.origin;
    for (int i = 0; i < 3; ++i) {
        g.dims[i] = old.geometry.dims[order[i]];
        g.index_to_world_axes[i] = old.geometry.index_to_world_axes[order[i]];
        if (!reversed[i]) continue;
        g.origin += static_cast<double>(g.dims[i] - 1) * g.index_to_world_axes[i];
        g.index_to_world_axes[i] = -g.index_to_world_axes[i];
    }
    for (int z = 0; z < g.dims.z; ++z)
        for (int y = 0; y < g.dims.y; ++y)
            for (int x = 0; x < g.dims.x; ++x) {
                const glm::ivec3 at(x, y, z);
                glm::ivec3 from(0);
                for (int i = 0; i < 3; ++i)
                    from[order[i]] = reversed[i] ? g.dims[i] - 1 - at[i] : at[i];
                stored->values.push_back(old.at(from.x, from.y, from.z));
            }
    finish_volume(*stored);
    shot.volume = stored;
    return shot;
}

Image picture_of(const Shot& shot) {
    return sound(shot, "a body").color;
}

TEST(SymmetryGrid, MirroredAcrossX) {
    expect_alike(picture_of(uneven()), flipped(picture_of(moved(uneven(), {-1, 0, 0, 0, 1, 0, 0, 0, 1}, {7, 0, 0}))),
                 "x");
}
TEST(SymmetryGrid, MirroredAcrossY) {
    expect_alike(picture_of(uneven()), flipped(picture_of(moved(uneven(), {1, 0, 0, 0, -1, 0, 0, 0, 1}, {0, 7, 0}))),
                 "y");
}
TEST(SymmetryGrid, MirroredAcrossZ) {
    expect_alike(picture_of(uneven()), flipped(picture_of(moved(uneven(), {1, 0, 0, 0, 1, 0, 0, 0, -1}, {0, 0, 7}))),
                 "z");
}
TEST(SymmetryGrid, MirroredThroughAPoint) {
    expect_alike(picture_of(uneven()), flipped(picture_of(moved(uneven(), glm::dmat3(-1)))), "x, y and z");
}
TEST(SymmetryGrid, TurnedByARightAngleAboutX) {
    expect_alike(picture_of(uneven()), picture_of(moved(uneven(), {1, 0, 0, 0, 0, 1, 0, -1, 0})), "about x");
}
TEST(SymmetryGrid, TurnedByARightAngleAboutY) {
    expect_alike(picture_of(uneven()), picture_of(moved(uneven(), {0, 0, -1, 0, 1, 0, 1, 0, 0})), "about y");
}
TEST(SymmetryGrid, TurnedByARightAngleAboutZ) {
    expect_alike(picture_of(uneven()), picture_of(moved(uneven(), {0, 1, 0, -1, 0, 0, 0, 0, 1})), "about z");
}
TEST(SymmetryGrid, StoredBackwardsAlongX) {
    expect_alike(picture_of(uneven()), picture_of(restored(uneven(), {0, 1, 2}, {true, false, false})), "x backwards");
}
TEST(SymmetryGrid, StoredBackwardsAlongY) {
    expect_alike(picture_of(uneven()), picture_of(restored(uneven(), {0, 1, 2}, {false, true, false})), "y backwards");
}
TEST(SymmetryGrid, StoredBackwardsAlongZ) {
    expect_alike(picture_of(uneven()), picture_of(restored(uneven(), {0, 1, 2}, {false, false, true})), "z backwards");
}
TEST(SymmetryGrid, StoredBackwardsAlongAll) {
    // This reverses the order of all splats, also within every sheet.
    expect_alike(picture_of(uneven()), picture_of(restored(uneven(), {0, 1, 2}, glm::bvec3(true))), "all backwards");
}
TEST(SymmetryGrid, StoredInAnyOrderOfAxes) {
    const Image want = picture_of(uneven());
    const glm::ivec3 orders[] = {{0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    for (const glm::ivec3& order : orders)
        expect_alike(want, picture_of(restored(uneven(), order)), fmt::format("{}{}{}", order.x, order.y, order.z));
}

TEST(SymmetryGrid, OrderWithinASheetDoesNotMatter) {
    // Plain kernels, whole sheets: only the order of float additions differs.
    Shot shot = uneven();
    shot.settings.edges = EdgeEstimator::Off;
    shot.scene.lights.clear();
    shot.settings.sheet_spacing = 16;
    shot.settings.saturation = 1;
    const Image want = picture_of(shot);
    EXPECT_LE(compare_images(want, picture_of(restored(shot, {0, 1, 2}, glm::bvec3(true)))).max, 5e-6);
    EXPECT_LE(compare_images(want, picture_of(restored(shot, {2, 0, 1}))).max, 5e-6);
}

/// Lengths in another unit; extinction is per length.
void expect_scaled(double scale) {
    Shot other = moved(uneven(), glm::dmat3(scale));
    for (Material& material : other.scene.materials)
        material.extinction /= scale;
    expect_alike(picture_of(uneven()), picture_of(other), fmt::format("scaled by {}", scale));
}

TEST(SymmetryGrid, InMetres) {
    expect_scaled(1e-3);
}
TEST(SymmetryGrid, InMicrometres) {
    expect_scaled(1e3);
}
TEST(SymmetryGrid, InNanometres) {
    expect_scaled(1e6);
}
TEST(SymmetryGrid, InKilometres) {
    expect_scaled(1e-6);
}
TEST(SymmetryGrid, InPicometresAndMegametres) {
    // The limits of a spacing.
    expect_scaled(1e-9);
    expect_scaled(7e8);
}

TEST(SymmetryGrid, FarFromTheOrigin) {
    // 10 km from the origin, in mm.
    expect_alike(picture_of(uneven()), picture_of(moved(uneven(), glm::dmat3(1), {1e7, -1e7, 1e7})), "10 km away");
}

/// The same body with values a v + b.
Shot with_values(Shot shot, double a, double b) {
    const auto axes = shot.volume->geometry.index_to_world_axes;
    const auto old = shot.volume;
    shot.volume = volume_of(
        old->geometry.dims,
        [&](const glm::ivec3& v) { return static_cast<float>(a * static_cast<double>(old->at(v.x, v.y, v.z)) + b); },
        axes);
    for (double& iso : shot.scene.iso_values)
        iso = a * iso + b;
    if (a < 0) {
        std::reverse(shot.scene.iso_values.begin(), shot.scene.iso_values.end());
        std::reverse(shot.scene.materials.begin(), shot.scene.materials.end());
    }
    return shot;
}

TEST(SymmetryGrid, WithValuesScaledAndShifted) {
    expect_alike(picture_of(uneven()), picture_of(with_values(uneven(), 400, -1000)), "400 v - 1000");
    expect_alike(picture_of(uneven()), picture_of(with_values(uneven(), 1e-9, 0)), "1e-9 v");
}

TEST(SymmetryGrid, WithNegatedValues) {
    // Normals point to lower values, so they are reversed: the comparison is without light.
    Shot shot = uneven();
    shot.scene.lights.clear();
    expect_alike(picture_of(shot), picture_of(with_values(shot, -1, 0)), "-v");
}

TEST(SymmetryGrid, MirroredForEveryEstimator) {
    for (const EdgeEstimator estimator : kEstimators) {
        Shot shot = uneven();
        shot.settings.edges = estimator;
        expect_alike(picture_of(shot), picture_of(restored(shot, {1, 0, 2}, {true, false, true})),
                     std::string(name_of(estimator)));
    }
}

TEST(SymmetryGrid, ForSlicedSheetsAndThePapersCurve) {
    Shot shot = uneven();
    shot.settings.sheets = SheetCut::Sliced;
    expect_alike(picture_of(shot), picture_of(restored(shot, {2, 1, 0}, {false, true, false})), "sliced");
    shot.settings = paper_settings(shot.settings);
    expect_alike(picture_of(shot), picture_of(restored(shot, {2, 1, 0}, {false, true, false})), "the paper's");
}

}  // namespace
}  // namespace edgesplat::test

// Sliced sheets converge to the model: to its direct evaluation, picture by picture and frame by frame.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <tuple>

#include "engine/accuracy/metrics.h"
#include "engine/reference/direct_evaluation.h"
#include "tests/properties/scenes.h"

namespace edgesplat::test {
namespace {

using accuracy::image_error;

/// A builtin scene on a small grid.
Shot builtin(const char* name, const glm::ivec3& dims, double extinction, int side) {
    const AnalyticScene scene = resized(analytic_scene(name), dims);
    Shot shot;
    shot.volume = std::make_shared<const Volume>(sample(scene));
    shot.scene.iso_values = scene.iso_values;
    shot.scene.materials.resize(scene.iso_values.size() + 1);
    if (scene.iso_values.size() > 1) shot.scene.materials[1] = {{0.3, 0.5, 1}, 0.12};
    shot.scene.materials.back() = {{1, 0.8, 0.55}, extinction};
    shot.settings.footprints = FootprintMode::Procedural;
    shot.settings.sheets = SheetCut::Sliced;
    shot.settings.saturation = 1;
    shot.settings.cull_buried = false;  // the model has all its kernels
    shot.width = shot.height = side;
    return shot;
}

/// Looks at the middle from an angle around the z axis, degrees.
void orbit(Shot& shot, double degrees) {
    const glm::dvec3 middle = glm::dvec3(shot.volume->geometry.dims - 1) / 2.0;
    const double angle = glm::radians(degrees), far = 2.2 * glm::length(middle);
    shot.camera = look(*shot.volume, middle + far * glm::dvec3(std::cos(angle), std::sin(angle), 0.45), middle, 38);
}

/// The model with an error of 2e-5 of full scale: a fiftieth of the smallest limit below.
Image model(const reference::PreparedVolume& prepared, const Shot& shot) {
    reference::DirectOptions options;
    options.tolerance = 2e-5;
    return reference::direct_evaluation(prepared, shot.camera, shot.width, shot.height, reference::Output::Color,
                                        options)
        .image;
}

TEST(Convergence, HalvingTheSheetsQuartersTheError) {
    for (const auto& [name, dims, extinction] :
         {std::tuple{"sphere", glm::ivec3(16), 1.0}, std::tuple{"phantom", glm::ivec3(18, 21, 18), 0.5}}) {
        Shot shot = builtin(name, dims, extinction, 32);
        orbit(shot, 25);
        const reference::PreparedVolume prepared(*shot.volume, shot.scene, shot.settings, true);
        const Image expected = model(prepared, shot);
        double before = 0;
        std::string line;
        for (const double spacing : {1.0, 0.5, 0.25, 0.125}) {
            shot.settings.sheet_spacing = spacing;
            const double rms = image_error(render(shot).color, expected).rms;
            line += fmt::format(" {}: {:.4f} %", spacing, 100 * rms);
            // A sheet only loses the order and the light of its content, by using means: the error is of second order.
            // Thick sheets have not converged yet; the thinnest reach the reference's own error.
            if (before > 4e-4) {
                EXPECT_GE(before / rms, spacing == 0.5 ? 2.6 : 3.2) << name << " at " << spacing;
            }
            before = rms;
        }
        std::printf("%s:%s\n", name, line.c_str());
        EXPECT_LE(before, 4e-4) << name << ": the thinnest sheets";
    }
}

TEST(Convergence, ThinSheetsMatchTheModelToATenthOfAPercent) {
    for (const auto& [name, extinction] :
         {std::pair{"cube-hole", 2.0}, std::pair{"torus", 1.0}, std::pair{"shell", 1.5}, std::pair{"orbital", 0.6}}) {
        Shot shot = builtin(name, glm::ivec3(20), extinction, 32);
        shot.settings.sheet_spacing = 0.125;
        orbit(shot, 35);
        const reference::PreparedVolume prepared(*shot.volume, shot.scene, shot.settings, true);
        const Image expected = model(prepared, shot), got = render(shot).color;
        const double rms = image_error(got, expected).rms;
        std::printf("%s: %.4f %% rms\n", name, 100 * rms);
        EXPECT_LE(rms, 2e-4) << name;  // measured 4e-5 to 1.4e-4; the requirement is a tenth of a percent
        EXPECT_GT(evenness(got).variation, 0.1) << name << ": an empty picture shows nothing";
    }
}

TEST(Convergence, HoldsWithTheEyeInsideTheVolume) {
    Shot shot = builtin("sphere", glm::ivec3(16), 0.3, 24);
    shot.settings.sheet_spacing = 0.125;
    const reference::PreparedVolume prepared(*shot.volume, shot.scene, shot.settings, true);
    shot.camera = look(*shot.volume, {6.3, 7.2, 8.1}, {12, 9, 7}, 80);
    const double rms = image_error(render(shot).color, model(prepared, shot)).rms;
    std::printf("inside: %.4f %% rms\n", 100 * rms);
    EXPECT_LE(rms, 8e-4);  // nearby, a sheet of 1/8 voxel is many pixels deep
}

/// RMS of (change of the method - change of the model) from frame to frame.
TEST(Popping, SlicedSheetsDoNotPop) {
    constexpr int kFrames = 3;
    for (const auto& [name, dims, extinction] :
         {std::tuple{"sphere", glm::ivec3(16), 1.0}, std::tuple{"cube-hole", glm::ivec3(18), 2.0},
          std::tuple{"phantom", glm::ivec3(16, 18, 16), 0.5}}) {
        Shot shot = builtin(name, dims, extinction, 64);
        shot.settings.sheet_spacing = 0.125;
        const reference::PreparedVolume prepared(*shot.volume, shot.scene, shot.settings, true);
        std::vector<Image> expected, sliced, whole;
        for (int frame = 0; frame < kFrames; ++frame) {
            orbit(shot, 40 + frame);
            expected.push_back(model(prepared, shot));
            sliced.push_back(render(shot).color);
            Shot other = shot;
            other.settings.sheets = SheetCut::Whole;
            whole.push_back(render(other).color);
        }
        const auto of_sliced = accuracy::popping(sliced, expected), of_whole = accuracy::popping(whole, expected);
        RecordProperty(std::string(name) + "_sliced_percent", std::to_string(100 * of_sliced.max_difference));
        RecordProperty(std::string(name) + "_whole_percent", std::to_string(100 * of_whole.max_difference));
        std::printf("%s: popping, sheets of .125: sliced %.4f %%, whole %.4f %%\n", name,
                    100 * of_sliced.max_difference, 100 * of_whole.max_difference);
        // The requirement is a tenth of a percent; on the sphere, whole kernels in equally thin sheets reach it, too.
        EXPECT_LE(of_sliced.max_difference, 2.5e-4) << name;
        EXPECT_LT(of_sliced.max_difference, of_whole.max_difference / 10) << name;
    }
}

}  // namespace
}  // namespace edgesplat::test

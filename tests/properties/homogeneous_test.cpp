// The opacity of a homogeneous slab follows its thickness, independent of the sheets: alpha = 1 - exp(-sigma L).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "engine/reference/3_select_footprints.h"
#include "tests/properties/scenes.h"

namespace edgesplat::test {
namespace {

struct Slab {
    const char* name;
    glm::dmat3 axes{1};
    glm::dvec3 normal{0, 0, 1};  ///< index space, unit
    double thickness = 10;       ///< voxels along the normal
    bool transfer = false;       ///< extinction by a transfer function
    double tolerance = 1.2e-3;   ///< sums of one side's kernels vary with the lattice
};

struct Errors {
    double worst = 0, apart = 0;  ///< difference to the closed form, and between sheets
    double least = 1, most = 0;   ///< range of the expected opacity
};

void PrintTo(const Slab& slab, std::ostream* out) {
    *out << slab.name;
}

class HomogeneousSlab : public testing::TestWithParam<Slab> {};

Errors errors_of(const Slab& slab, const Settings& settings) {
    const glm::dvec3 centre(19.3, 19.6, 19.45);
    Shot shot;
    shot.volume =
        placed(std::make_shared<const Volume>(sample(slab_scene({40, 40, 40}, slab.normal, centre, slab.thickness))),
               slab.axes);
    const double sigma = 0.08;
    shot.scene.iso_values = {0.5};
    shot.scene.materials = {{}, {{1, 1, 1}, sigma}};
    if (slab.transfer) {
        shot.scene.materials = {{}, {}};
        shot.scene.transfer = {{0.4, {1, 1, 1}, 0}, {0.6, {1, 1, 1}, sigma}};
    }
    shot.scene.lights.clear();
    shot.settings = settings;
    shot.settings.saturation = 1;
    shot.width = shot.height = 8;
    // The slab's faces in world space.
    const glm::dvec3 n_world = glm::transpose(glm::inverse(slab.axes)) * slab.normal;
    Errors errors;
    for (const glm::dvec3& direction : {glm::dvec3(0), glm::dvec3(0.45, 0.1, 0), glm::dvec3(-0.3, 0.35, 0.2)}) {
        const glm::dvec3 towards = glm::normalize(glm::normalize(n_world) + direction);
        shot.camera.direction = towards;
        shot.camera.eye = shot.volume->geometry.to_world(centre) - 300.0 * towards;
        shot.camera.up = {0.3, 1, 0.1};
        shot.camera.fov_y = 0.8;
        const reference::View view(shot.camera, shot.volume->geometry, 8, 8);
        Image first;
        for (const SheetCut sheets : {SheetCut::Whole, SheetCut::Sliced}) {
            for (const double spacing : {0.25, 1.0, 4.0}) {
                shot.settings.sheets = sheets;
                shot.settings.sheet_spacing = spacing;
                const Image picture = render(shot).color;
                if (first.pixels.empty()) first = picture;
                for (int y = 0; y < 8; ++y) {
                    for (int x = 0; x < 8; ++x) {
                        const auto got = static_cast<double>(picture.at(x, y, 3));
                        const glm::dvec3 u = view.ray(x, y);
                        const double mm = glm::length(slab.axes * u);
                        const double length = slab.thickness / std::abs(glm::dot(slab.normal, u)) * mm;
                        const double want = -std::expm1(-sigma * length);
                        errors.apart = std::max(errors.apart, std::abs(got - static_cast<double>(first.at(x, y, 3))));
                        errors.worst = std::max(errors.worst, std::abs(got - want));
                        errors.least = std::min(errors.least, want);
                        errors.most = std::max(errors.most, want);
                    }
                }
            }
        }
    }
    return errors;
}

TEST_P(HomogeneousSlab, HasTheOpacityOfItsThicknessForAnySheets) {
    const Slab& slab = GetParam();
    const Errors e = errors_of(slab, {});
    std::printf("%-30s alpha %.3f to %.3f, worst %.1e, between sheets %.1e\n", slab.name, e.least, e.most, e.worst,
                e.apart);
    EXPECT_GT(e.least, 0.3);
    EXPECT_LT(e.most, 0.95);
    EXPECT_LE(e.worst, slab.tolerance);
    EXPECT_LE(e.apart, 1.5e-3);
}

INSTANTIATE_TEST_SUITE_P(
    All, HomogeneousSlab,
    testing::Values(
        Slab{"material"},
        Slab{.name = "material_oblique", .normal = glm::normalize(glm::dvec3(0.5, 0.3, 1)), .tolerance = 3e-3},
        Slab{.name = "material_oblique_otherwise",
             .normal = glm::normalize(glm::dvec3(0.9, 0.1, 0.4)),
             .tolerance = 3.5e-3},
        Slab{.name = "material_diagonal", .normal = glm::normalize(glm::dvec3(1, 1, 0)), .tolerance = 1.5e-3},
        Slab{.name = "material_space_diagonal", .normal = glm::normalize(glm::dvec3(1, 1, 1)), .tolerance = 2.8e-3},
        // Near the grid's own planes all voxels of a face have similar errors, and smoothing helps little.
        Slab{.name = "material_tilted", .normal = glm::normalize(glm::dvec3(0.06, 0.04, 1)), .tolerance = 3e-3},
        Slab{.name = "material_between_samples", .thickness = 10.37, .tolerance = 3.2e-3},
        Slab{.name = "material_anisotropic",
             .axes = glm::dmat3(glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 2.5)),
             .thickness = 6},
        Slab{.name = "material_anisotropic_across",
             .axes = glm::dmat3(glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 2.5)),
             .normal = glm::dvec3(1, 0, 0)},
        // Up to 62 degrees across the face in index space: twice the length per voxel.
        Slab{.name = "material_anisotropic_oblique",
             .axes = glm::dmat3(glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 2.5)),
             .normal = glm::normalize(glm::dvec3(0.5, 0.3, 1)),
             .thickness = 6,
             .tolerance = 4.7e-3},
        Slab{.name = "transfer", .transfer = true},
        Slab{.name = "transfer_oblique",
             .normal = glm::normalize(glm::dvec3(0.5, 0.3, 1)),
             .transfer = true,
             .tolerance = 3e-3},
        Slab{.name = "transfer_anisotropic",
             .axes = glm::dmat3(glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 2.5)),
             .thickness = 6,
             .transfer = true}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(HomogeneousBox, HasTheOpacityOfItsThicknessWithoutIsoValues) {
    // All voxels are equal: the sum of kernels is one inside, and its integral along an axis is the length of the box.
    Shot shot;
    shot.volume = sampled(
        {32, 32, 12}, [](const glm::dvec3&) { return 7.0; },
        glm::dmat3(glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 2.5)));
    shot.scene.iso_values.clear();
    shot.scene.materials = {{}};
    shot.scene.transfer = {{6, {1, 1, 1}, 0.02}, {8, {1, 1, 1}, 0.06}};
    shot.scene.lights.clear();
    shot.settings.saturation = 1;
    shot.width = shot.height = 8;
    for (const glm::dvec3& direction : {glm::dvec3(0, 0, 1), glm::dvec3(0.2, -0.1, -1)}) {
        const glm::dvec3 towards = glm::normalize(direction);
        shot.camera.direction = towards;
        shot.camera.eye = shot.volume->geometry.to_world({15.5, 15.5, 5.5}) - 300.0 * towards;
        shot.camera.up = {0.3, 1, 0.1};
        shot.camera.fov_y = 0.5;
        const reference::View view(shot.camera, shot.volume->geometry, 8, 8);
        for (const SheetCut sheets : {SheetCut::Whole, SheetCut::Sliced}) {
            for (const double spacing : {0.25, 1.0, 4.0}) {
                shot.settings.sheets = sheets;
                shot.settings.sheet_spacing = spacing;
                const Image picture = render(shot).color;
                for (int y = 0; y < 8; ++y) {
                    for (int x = 0; x < 8; ++x) {
                        const glm::dvec3 u = view.ray(x, y);
                        const double length =
                            12 / std::abs(u.z) * glm::length(shot.volume->geometry.index_to_world_axes * u);
                        EXPECT_NEAR(static_cast<double>(picture.at(x, y, 3)), -std::expm1(-0.04 * length), 1e-3);
                    }
                }
            }
        }
    }
}

}  // namespace
}  // namespace edgesplat::test

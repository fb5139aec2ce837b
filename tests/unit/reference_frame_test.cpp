// Passes 2 to 7 and whole frames of the reference.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "engine/error.h"
#include "engine/reference/6_composite_sheet.h"
#include "engine/reference/direct_evaluation.h"
#include "footprints/kernel.h"
#include "tests/unit/reference_volumes.h"

namespace edgesplat::reference {
namespace {

using namespace testing_volumes;

Settings procedural(EdgeEstimator edges = EdgeEstimator::March) {
    Settings settings;
    settings.edges = edges;
    settings.footprints = FootprintMode::Procedural;
    return settings;
}

double largest_frame_difference(const Image& a, const Image& b) {
    double most = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        most = std::max(most, std::abs(static_cast<double>(a.pixels[i]) - static_cast<double>(b.pixels[i])));
    }
    return most;
}

double psnr(const Image& a, const Image& b) {
    double squares = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        const double d = static_cast<double>(a.pixels[i]) - static_cast<double>(b.pixels[i]);
        squares += d * d;
    }
    return -10 * std::log10(squares / static_cast<double>(a.pixels.size()));
}

TEST(SortSheets, IsAStablePermutation) {
    std::mt19937 random(3);
    std::vector<Selected> selected(5000);
    for (Selected& s : selected) {
        s.kept = random() % 3 != 0;
        s.sheet = s.last_sheet = static_cast<int>(random() % 40);
    }
    const SortedSheets sorted = sort_sheets(selected);
    EXPECT_EQ(std::set(sorted.order.begin(), sorted.order.end()).size(), sorted.order.size());
    EXPECT_EQ(static_cast<std::ptrdiff_t>(sorted.order.size()),
              std::count_if(selected.begin(), selected.end(), [](const Selected& s) { return s.kept; }));
    for (std::size_t sheet = 0; sheet < sorted.sheets(); ++sheet) {
        const auto members = sorted.sheet(sheet);
        EXPECT_TRUE(std::is_sorted(members.begin(), members.end()));
        for (const auto i : members)
            EXPECT_EQ(selected[i].sheet, static_cast<int>(sheet));
    }
    EXPECT_EQ(sort_sheets({}).sheets(), 0U);
}

TEST(SortSheets, ListsSplatOnceInEachOfItsSheets) {
    std::mt19937 random(4);
    std::vector<Selected> selected(3000);
    std::size_t places = 0;
    for (Selected& s : selected) {
        s.kept = random() % 3 != 0;
        s.sheet = static_cast<int>(random() % 40);
        s.last_sheet = s.sheet + static_cast<int>(random() % 12);
        places += s.kept ? static_cast<std::size_t>(s.last_sheet - s.sheet + 1) : 0U;
    }
    const SortedSheets sorted = sort_sheets(selected);
    EXPECT_EQ(sorted.order.size(), places);
    for (std::size_t sheet = 0; sheet < sorted.sheets(); ++sheet) {
        const auto members = sorted.sheet(sheet);
        EXPECT_TRUE(std::is_sorted(members.begin(), members.end()));
        EXPECT_EQ(std::adjacent_find(members.begin(), members.end()), members.end()) << "twice in one sheet";
        for (const auto i : members) {
            EXPECT_TRUE(selected[i].kept);
            EXPECT_LE(selected[i].sheet, static_cast<int>(sheet));
            EXPECT_GE(selected[i].last_sheet, static_cast<int>(sheet));
        }
    }
}

TEST(ScreenBox, EnclosesPixelsOfSphereTightly) {
    VolumeGeometry geometry;
    geometry.dims = glm::ivec3(10);
    geometry.index_to_world_axes = glm::dmat3(1.0, 0.2, 0.0, 0.0, 0.7, -0.1, 0.3, 0.0, -2.0);  // oblique, left-handed
    Camera camera;
    camera.eye = {3, -30, 2};
    camera.direction = {0.1, 1, -0.3};
    const View view(camera, geometry, 160, 120);
    for (const glm::dvec3 center : {glm::dvec3(5), glm::dvec3(0, 9, 3), glm::dvec3(9, 2, 7)}) {
        const SplatSupport support{center, 1.6};
        PixelBox seen{160, 120, 0, 0};
        for (int y = 0; y < 120; ++y) {
            for (int x = 0; x < 160; ++x) {
                const glm::dvec3 v = center - view.eye_index;
                if (!(glm::length(glm::cross(view.ray(x, y), v)) < support.radius)) continue;
                seen = {std::min(seen.x0, x), std::min(seen.y0, y), std::max(seen.x1, x + 1), std::max(seen.y1, y + 1)};
            }
        }
        const PixelBox box = screen_box(view, support);
        // A box may contain an extra row or column at each side, but must not miss one.
        EXPECT_LE(box.x0, seen.x0);
        EXPECT_LE(box.y0, seen.y0);
        EXPECT_GE(box.x1, seen.x1);
        EXPECT_GE(box.y1, seen.y1);
        EXPECT_LE(seen.x0 - box.x0 + seen.y0 - box.y0 + box.x1 - seen.x1 + box.y1 - seen.y1, 4);
    }
}

TEST(CompositeSheet, SaturatesWithoutOverflow) {
    std::vector<glm::dvec4> frame(3, glm::dvec4(0));
    const std::vector<glm::dvec4> sheet{{1e6, 5e5, 0, 1e6}, {0, 0, 0, 0}, {1e-30, 0, 0, 1e-30}};
    composite_sheet(frame, sheet);
    EXPECT_EQ(frame[0], glm::dvec4(1, 0.5, 0, 1));
    EXPECT_EQ(frame[1], glm::dvec4(0));
    EXPECT_NEAR(frame[2].x / 1e-30, 1, 1e-12);
    const std::vector<char> closed{0, 1, 0};
    const std::vector<glm::dvec4> next(3, glm::dvec4(1));
    composite_sheet(frame, next, closed);
    EXPECT_EQ(frame[0], glm::dvec4(1, 0.5, 0, 1));  // opaque already
    EXPECT_EQ(frame[1], glm::dvec4(0));             // marked as saturated
}

TEST(Frame, ConstantSlabObeysBeerLambertLaw) {
    // 0.3 per mm through 12 voxels of 0.5 mm.
    const Volume slab = sampled(
        glm::ivec3(20, 12, 20), [](const glm::dvec3&) { return 5.0; }, glm::dmat3(0.5));
    Scene scene = solid_scene(0.3);
    scene.lights.clear();
    const Camera camera = looking_at(slab, {0, 1, 0}, 200, 0.4);
    for (const double spacing : {0.3, 1.0, 4.0}) {
        Settings settings = procedural();
        settings.sheet_spacing = spacing;
        const Image picture = render(slab, scene, camera, settings, 5, 5);
        const double alpha = -std::expm1(-0.3 * 0.5 * 12);
        EXPECT_NEAR(static_cast<double>(picture.at(2, 2, 3)), alpha, 5e-4);
        EXPECT_NEAR(static_cast<double>(picture.at(2, 2, 1)), alpha * 0.8, 5e-4);
    }
}

TEST(Frame, EqualsPlainSplattingWithoutEdges) {
    const Volume volume = ball(16, 5);
    const Camera camera = looking_at(volume, {1, 2, -1}, 60, 20);
    Settings isotropic = procedural();
    isotropic.footprints = FootprintMode::Isotropic;
    const Image plain = render(volume, solid_scene(1), camera, procedural(EdgeEstimator::Off), 40, 40, Output::Tau);
    EXPECT_EQ(plain.pixels, render(volume, solid_scene(1), camera, isotropic, 40, 40, Output::Tau).pixels);
    const Image warped = render(volume, solid_scene(1), camera, procedural(), 40, 40, Output::Tau);
    EXPECT_GT(largest_frame_difference(plain, warped), 0.1);
}

TEST(Frame, IsIndependentOfAxisOrder) {
    const auto value = [](const glm::dvec3& x) {
        return blurred(glm::length(x - glm::dvec3(6, 7, 5)) - 4 + 0.3 * x.y);
    };
    const glm::dmat3 axes(0.5, 0.1, 0, 0, 0.8, 0.2, 0.1, 0, 1.1);
    const Volume first = sampled({12, 14, 11}, value, axes);
    // The same samples with z, x, y running fastest first, and the last of them backwards.
    Volume second = sampled(
        {11, 12, 14},
        [&](const glm::dvec3& x) {
            return value({x.y, 13 - x.z, x.x});
        },
        glm::dmat3(axes[2], axes[0], -axes[1]));
    second.geometry.origin = 13.0 * axes[1];
    const Camera camera = looking_at(first, {1, 2, -1}, 30, 30);
    const PreparedVolume a(first, solid_scene(2), procedural());
    const PreparedVolume b(second, solid_scene(2), procedural());
    const Image opacity = a.render(camera, 48, 40);
    EXPECT_LT(largest_frame_difference(opacity, b.render(camera, 48, 40)), 1e-5);
    EXPECT_LT(largest_frame_difference(a.render(camera, 48, 40, Output::Tau), b.render(camera, 48, 40, Output::Tau)),
              1e-5);
    for (const Output output : {Output::Depth, Output::Normal}) {
        const Image x = a.render(camera, 48, 40, output);
        const Image y = b.render(camera, 48, 40, output);
        for (int i = 0; i < 48 * 40; ++i) {
            // Means are not comparable where rounding decides whether a ray touches a support.
            if (!(opacity.at(i % 48, i / 48, 3) > 1e-4F)) continue;
            for (int c = 0; c < x.channels; ++c)
                EXPECT_NEAR(x.at(i % 48, i / 48, c), y.at(i % 48, i / 48, c), 1e-3);
        }
    }
}

TEST(Frame, IsInvariantUnderCommonRotation) {
    const Volume volume = ball(14, 4.3);
    const double c = std::cos(0.7);
    const double s = std::sin(0.7);
    const glm::dmat3 turn(c, s, 0, -s * c, c * c, s, s * s, -s * c, c);
    Volume turned = volume;
    turned.geometry.index_to_world_axes = turn;
    turned.geometry.origin = turn * glm::dvec3(0) + glm::dvec3(5, -3, 2);
    const Camera camera = looking_at(volume, {1, 2, -1}, 40, 30);
    Camera other = camera;
    other.eye = turn * camera.eye + glm::dvec3(5, -3, 2);
    other.direction = turn * camera.direction;
    other.up = turn * camera.up;
    EXPECT_LT(largest_frame_difference(render(volume, solid_scene(1), camera, procedural(), 40, 40),
                                       render(turned, solid_scene(1), other, procedural(), 40, 40)),
              1e-6);
}

TEST(Frame, AgreesWithDirectEvaluation) {
    const Volume volume = ball(12, 3.6);
    const Camera camera = looking_at(volume, {1, 2, -1}, 40, 20);
    const PreparedVolume prepared(volume, solid_scene(0.2), procedural());
    const Image splatted = prepared.render(camera, 48, 48, Output::Tau);
    EXPECT_GT(psnr(splatted, direct_evaluation(prepared, camera, 48, 48, Output::Tau).image), 50);
    const Image color = prepared.render(camera, 48, 48);
    EXPECT_GT(psnr(color, direct_evaluation(prepared, camera, 48, 48, Output::Color).image), 40);
}

TEST(Frame, CullingBuriedVoxelsKeepsPicture) {
    const Volume volume = ball(32, 14);
    Settings all = procedural(EdgeEstimator::Off);
    all.cull_buried = false;
    const Settings culled = procedural(EdgeEstimator::Off);
    const Camera camera = looking_at(volume, {1, 2, -1}, 90, 30);
    const PreparedVolume prepared(volume, solid_scene(4), culled);
    const auto count = [&](const Settings& settings, const glm::dvec3& eye, bool tau) {
        return collect_splats(prepared.field(), prepared.scaled_scene(), prepared.edges(), prepared.scene(),
                              volume.geometry, settings, eye, tau)
            .size();
    };
    EXPECT_LT(count(culled, camera.eye, false), count(all, camera.eye, false));
    EXPECT_EQ(count(culled, glm::dvec3(15.5), false), count(all, camera.eye, false));  // from inside
    EXPECT_EQ(count(culled, camera.eye, true), count(all, camera.eye, false));
    const Image a = prepared.render(camera, 40, 40);
    const Image b = render(volume, solid_scene(4), camera, all, 40, 40);
    EXPECT_LT(largest_frame_difference(a, b), 1.0 / 255);
}

TEST(Frame, EveryOutputIsFiniteFromInsideTheVolume) {
    const Volume volume = ball(14, 4);
    Camera camera = looking_at(volume, {1, 2, -1}, 4.2, 100);
    for (const double distance : {0.0, 4.2}) {
        camera.eye = glm::dvec3(6.5) - distance * camera.direction;
        for (const Output output : {Output::Color, Output::Tau, Output::Depth, Output::Distance, Output::Normal}) {
            const Image picture = render(volume, solid_scene(1), camera, procedural(), 24, 20, output);
            for (const float v : picture.pixels)
                ASSERT_TRUE(std::isfinite(v));
        }
    }
}

TEST(Frame, OutputsHaveExpectedValues) {
    const Volume volume = ball(24, 8);
    const Camera camera = looking_at(volume, {0, 1, 0}, 80, 10);
    const PreparedVolume prepared(volume, solid_scene(20), procedural());
    const auto centre = [&](Output output, int channel) {
        return static_cast<double>(prepared.render(camera, 21, 21, output).at(10, 10, channel));
    };
    EXPECT_NEAR(centre(Output::Depth, 0), 72, 0.7);
    EXPECT_NEAR(centre(Output::Normal, 1), -1, 0.01);
    EXPECT_NEAR(centre(Output::Distance, 0), -0.3, 0.3);
    EXPECT_NEAR(centre(Output::Tau, 0), 320, 10);
    EXPECT_NEAR(centre(Output::Color, 3), 1, 1e-3);
}

TEST(Frame, RefusesInvalidRequests) {
    const Volume volume = ball(8, 2);
    const PreparedVolume prepared(volume, solid_scene(1), procedural());
    EXPECT_THROW(prepared.render({}, 0, 10), Error);
    EXPECT_THROW(direct_evaluation(prepared, {}, 4, 4, Output::Depth), Error);
    Scene scene = solid_scene(1);
    scene.materials.clear();
    EXPECT_THROW(PreparedVolume(volume, scene, procedural()), Error);
}

}  // namespace
}  // namespace edgesplat::reference

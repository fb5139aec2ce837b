// Clip planes and boxes: position of the cut, remaining matter, and finite numbers for every plane and eye.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "engine/scene/clip_planes.h"
#include "footprints/kernel.h"
#include "tests/properties/scenes.h"

namespace edgesplat::test {
namespace {

constexpr double kBall = 9;                  // radius, voxels
const glm::dvec3 kMiddle(13.3, 13.6, 13.4);  // of the ball

VolumePointer ball() {
    static const VolumePointer volume =
        std::make_shared<const Volume>(sample(sphere_scene(glm::ivec3(28), kMiddle, kBall)));
    return volume;
}

Plane beyond(const glm::dvec3& point, const glm::dvec3& normal) {
    return {point, normal};
}

/// Six planes around [low, high], normals outwards.
std::vector<Plane> box(const glm::dvec3& low, const glm::dvec3& high) {
    return {{low, {-1, 0, 0}}, {low, {0, -1, 0}}, {low, {0, 0, -1}},
            {high, {1, 0, 0}}, {high, {0, 1, 0}}, {high, {0, 0, 1}}};
}

/// Length in voxels of the line through `at` along u (unit) that lies in the ball and is kept.
double kept_chord(const Clip& clip, const glm::dvec3& at, const glm::dvec3& u) {
    const glm::dvec3 p = at - glm::dot(at - kMiddle, u) * u;  // nearest to the middle
    const double half2 = kBall * kBall - glm::dot(p - kMiddle, p - kMiddle);
    if (!(half2 > 0)) return 0;
    double sum = 0;
    for (const KeptPiece& piece : index_clip(clip, ball()->geometry).kept_along(p, u)) {
        sum += std::max(0.0, std::min(piece.last, std::sqrt(half2)) - std::max(piece.first, -std::sqrt(half2)));
    }
    return sum;
}

/// The ray of a pixel; world = index.
glm::dvec3 ray_of(const Shot& shot, double x, double y) {
    const CameraFrame f = camera_frame(shot.camera);
    const double sx = (2 * (x + 0.5) / shot.width - 1) * f.tan_half_y * shot.width / shot.height;
    const double sy = (1 - 2 * (y + 0.5) / shot.height) * f.tan_half_y;
    return glm::normalize(f.forward + sx * f.right + sy * f.up);
}

/// The last x, in pixels, where a row falls below `level`; linear between pixels.
double last_crossing(const std::vector<double>& row, double level) {
    for (std::size_t x = row.size() - 1; x-- > 0;)
        if (row[x] >= level && row[x + 1] < level)
            return static_cast<double>(x) + (row[x] - level) / (row[x] - row[x + 1]);
    return NAN;
}

/// The ball cut by a plane of normal n through its middle + shift n, seen at `degrees` to the plane from the removed
/// side. Screen +x points across the furthest rim.
Shot cut_ball(const glm::dvec3& n, const glm::dvec3& along, double shift, double degrees, double pixels_per_voxel) {
    Shot shot;
    shot.volume = ball();
    shot.scene = two_tone(0, 8);
    shot.scene.effects.clip.keep = {beyond(kMiddle + shift * n, n)};
    const double angle = glm::radians(degrees);
    shot.width = static_cast<int>(24 * pixels_per_voxel);
    shot.height = 16;
    const glm::dvec3 direction = std::cos(angle) * along - std::sin(angle) * n;
    const glm::dvec3 right = std::cos(angle) * n + std::sin(angle) * along;
    shot.camera = camera_at(kMiddle, direction, right, shot.height, pixels_per_voxel);
    return shot;
}

// Both sides of the comparison use half opacity: the ray has passed ln 2 / sigma of matter.
TEST(Clip, CutsAtThePlaneAtEveryAngle) {
    constexpr double kScale = 8;  // pixels per voxel
    for (const SheetCut sheets : {SheetCut::Whole, SheetCut::Sliced}) {
        for (const double degrees : {0.0, 10.0, 45.0, 80.0}) {
            std::vector<double> errors;
            for (const Pose& pose : poses(2)) {
                Shot shot = cut_ball(pose.n, pose.along, 0.37, degrees, kScale);
                shot.settings.sheets = sheets;
                shot.settings.saturation = 1;
                const Image color = render(shot).color;
                for (int y = 2; y < shot.height; y += 5) {
                    std::vector<double> expected(static_cast<std::size_t>(shot.width));
                    const glm::dvec3 eye = shot.camera.eye;
                    for (int x = 0; x < shot.width; ++x) {
                        expected[static_cast<std::size_t>(x)] =
                            1 - std::exp(-8 * kept_chord(shot.scene.effects.clip, eye, ray_of(shot, x, y)));
                    }
                    const double got = last_crossing(row_of(color, y, nullptr, 3), 0.5);
                    const double want = last_crossing(expected, 0.5);
                    ASSERT_TRUE(std::isfinite(got) && std::isfinite(want)) << degrees << ", row " << y;
                    errors.push_back((got - want) / kScale);
                }
            }
            std::printf("cut at %2.0f degrees, %s: %.4f voxel on average, %.4f at most\n", degrees,
                        std::string(name_of(sheets)).c_str(), mean_magnitude(errors), largest_magnitude(errors));
            EXPECT_LE(largest_magnitude(errors), degrees == 0 ? 0.05 : 0.1) << degrees;
            EXPECT_LE(mean_magnitude(errors), 0.05) << degrees;
        }
    }
}

TEST(Clip, HalfABallAbsorbsByItsChord) {
    const glm::dvec3 n = glm::normalize(glm::dvec3(0.3, 1, -0.2));
    for (const double shift : {0.0, 0.5, 3.1}) {
        Shot shot;
        shot.volume = ball();
        shot.scene = two_tone(0, 0.05);
        shot.scene.effects.clip.keep = {beyond(kMiddle + shift * n, n)};
        shot.width = shot.height = 48;
        shot.camera = look(*shot.volume, {60, -80, 40}, kMiddle, 12);
        const Image tau = render_tau(shot);
        Shot whole = shot;
        whole.scene.effects.clip = {};
        const Image uncut = render_tau(whole);
        double worst = 0, cut = 0;
        for (int y = 0; y < shot.height; ++y) {
            for (int x = 0; x < shot.width; ++x) {
                const glm::dvec3 u = ray_of(shot, x, y);
                const double chord = kept_chord(shot.scene.effects.clip, shot.camera.eye, u);
                const double all = kept_chord({}, shot.camera.eye, u);
                if (all < 14 || chord < 6) continue;
                worst = std::max(worst, std::abs(static_cast<double>(tau.at(x, y, 0)) / (0.05 * chord) - 1));
                cut += all - chord;
            }
        }
        std::printf("half a ball, shift %.1f: tau off by %.2f %% at most\n", shift, 100 * worst);
        EXPECT_LE(worst, 0.01);
        EXPECT_GT(cut, 100) << "nothing was cut";
    }
}

/// A uniform block, 24 voxels wide, to measure tau per voxel of chord.
Shot block(double extinction = 0.05) {
    static const VolumePointer volume = sampled(glm::ivec3(24), [](const glm::dvec3&) { return 1.0; });
    Shot shot;
    shot.volume = volume;
    shot.scene = two_tone(0, extinction);
    shot.width = shot.height = 24;
    shot.camera = look(*shot.volume, {31, -90, 22}, glm::dvec3(11.5), 3);
    return shot;
}

// Only sums of kernels between planes: the remaining error is the kernel's own ripple.
TEST(Clip, SlabsBetweenPlanesHaveTheirThickness) {
    double worst = 0;
    int rays = 0;
    for (const Pose& pose : poses(3)) {
        for (const double thickness : {0.2, 1.0, 4.3}) {
            for (const bool removed : {false, true}) {
                Shot shot = block();
                const glm::dvec3 middle = glm::dvec3(11.5) + pose.shift;
                const std::vector<Plane> slab = {beyond(middle + thickness / 2 * pose.n, pose.n),
                                                 beyond(middle - thickness / 2 * pose.n, -pose.n)};
                (removed ? shot.scene.effects.clip.remove : shot.scene.effects.clip.keep) = slab;
                const Image tau = render_tau(shot);
                Shot whole = shot;
                whole.scene.effects.clip = {};
                const Image all = render_tau(whole);
                for (int y = 0; y < shot.height; y += 3) {
                    for (int x = 0; x < shot.width; x += 3) {
                        const double across = std::abs(glm::dot(ray_of(shot, x, y), pose.n));
                        const double length = thickness / across;
                        const glm::dvec3 eye = shot.camera.eye, u = ray_of(shot, x, y);
                        const glm::dvec3 at = eye + glm::dot(middle - eye, pose.n) / glm::dot(u, pose.n) * u - 11.5;
                        if (std::max({std::abs(at.x), std::abs(at.y), std::abs(at.z)}) + length / 2 > 9) continue;
                        ++rays;
                        const double part = static_cast<double>(tau.at(x, y, 0)) / 0.05;
                        const double got = removed ? static_cast<double>(all.at(x, y, 0)) / 0.05 - part : part;
                        worst = std::max(worst, std::abs(got - length) * across);
                    }
                }
            }
        }
    }
    std::printf("slabs between clip planes: thickness off by %.1e voxel at most\n", worst);
    EXPECT_LE(worst, 3e-3);
    EXPECT_GT(rays, 200);
}

TEST(Clip, PlanesOutsideTheVolumeChangeNothing) {
    Shot shot = torus_shot();
    shot.width = shot.height = 48;
    for (const SheetCut sheets : {SheetCut::Whole, SheetCut::Sliced}) {
        shot.settings.sheets = sheets;
        shot.scene.effects.clip = {};
        const Image plain = render(shot).color;
        shot.scene.effects.clip.keep = box(glm::dvec3(-9), glm::dvec3(50));
        const Image kept = render(shot).color;
        shot.scene.effects.clip.remove = box(glm::dvec3(-60), glm::dvec3(-50));
        const Image both = render(shot).color;
        const double keep_off = compare_images(plain, kept).max, both_off = compare_images(plain, both).max;
        std::printf("nothing cut, %s: off by %.1e, %.1e\n", std::string(name_of(sheets)).c_str(), keep_off, both_off);
        EXPECT_LE(keep_off, 1e-6);
        EXPECT_LE(both_off, 1e-6);
    }
}

TEST(Clip, ShowsTheBackgroundIfEverythingIsCut) {
    Shot shot = torus_shot();
    shot.width = shot.height = 32;
    shot.scene.background = {0.25, 0.5, 0.75};
    std::vector<Clip> clips(4);
    clips[0].keep = {beyond({0, 0, -20}, {0, 0, 1})};
    clips[1].remove = box(glm::dvec3(-9), glm::dvec3(50));
    clips[2].keep = {beyond({0, 0, 8}, {0, 0, 1}), beyond({0, 0, 9}, {0, 0, -1})};  // no point is on both near sides
    clips[3].remove = {beyond({0, 0, 90}, {0, 0, 1})};
    for (const Clip& clip : clips) {
        shot.scene.effects.clip = clip;
        const RenderResult r = render(shot, {true, true, true, true});
        EXPECT_EQ(r.stats.splats_drawn == 0 || clip.keep.size() == 2, true);
        for (int y = 0; y < shot.height; ++y)
            for (int x = 0; x < shot.width; ++x)
                for (int c = 0; c < 4; ++c)
                    ASSERT_EQ(r.color.at(x, y, c), c == 3 ? 0.0F : 0.25F * static_cast<float>(c + 1));
        EXPECT_TRUE(within(*r.tau, 0, 0));
        EXPECT_TRUE(within(*r.depth, 0, 0));
        EXPECT_TRUE(within(*r.normal, 0, 0));
    }
}

TEST(Clip, MirroredScenesGiveMirroredPictures) {
    Shot shot = block(1);
    shot.scene.lights = {Light{}};
    shot.camera = look(*shot.volume, {11.5, -60, 11.5}, glm::dvec3(11.5), 30, {0, 0, 1});
    shot.width = shot.height = 64;
    // Between voxels, and through voxels.
    for (const double at : {11.5, 12.0, 15.0}) {
        shot.scene.effects.clip.keep = {beyond({at, 11.5, 11.5}, {1, 0.4, 0})};
        const Image right = render(shot).color;
        shot.scene.effects.clip.keep = {beyond({23 - at, 11.5, 11.5}, {-1, 0.4, 0})};
        const Image left = render(shot).color;
        EXPECT_LE(compare_images(right, flipped(left)).max, 2e-4) << at;
        EXPECT_GT(compare_images(right, left).max, 0.1) << at;
    }
}

TEST(Clip, TheCutIsLitByItsOwnNormal) {
    Shot shot = block(6);
    const glm::dvec3 n = glm::normalize(glm::dvec3(0.4, -1, 0.3));
    shot.scene.effects.clip.keep = {beyond(glm::dvec3(11.5), n)};
    shot.scene.materials[1].color = {0.8, 0.6, 0.4};
    shot.scene.ambient = 0.2;
    shot.scene.lights = {directional_light({0.5, -1, 0.2})};
    const double facing = glm::dot(n, glm::normalize(glm::dvec3(0.5, -1, 0.2)));
    const glm::dvec3 want = shot.scene.materials[1].color * (0.2 + shot.scene.lights[0].intensity * facing);
    for (const SheetCut sheets : {SheetCut::Whole, SheetCut::Sliced}) {
        shot.settings.sheets = sheets;
        const RenderResult r = render(shot, {.depth = true, .normal = true});
        for (int y = 4; y < 20; ++y) {
            for (int x = 4; x < 20; ++x) {
                for (int c = 0; c < 3; ++c) {
                    ASSERT_NEAR(static_cast<double>(r.color.at(x, y, c)), want[c], 0.01);
                    ASSERT_NEAR(static_cast<double>(r.normal->at(x, y, c)), n[c], 0.02);
                }
                const glm::dvec3 u = ray_of(shot, x, y), eye = shot.camera.eye;
                const double t = glm::dot(n, glm::dvec3(11.5) - eye) / glm::dot(n, u);
                const double depth = t * glm::dot(u, glm::normalize(shot.camera.direction));
                ASSERT_NEAR(static_cast<double>(r.depth->at(x, y, 0)), depth, 0.1);
            }
        }
    }
}

TEST(Clip, GivesFiniteNumbersForExtremePlanesAndEyes) {
    struct Place {
        const char* name;
        glm::dvec3 eye, towards;
        Plane plane;
    };
    const glm::dvec3 m = kMiddle;
    const Place places[] = {
        {"eye on the plane, looking along it", m, {1, 0, 0}, {m, {0, 0, 1}}},
        {"eye on the plane, looking at it", m, {0, 0, 1}, {m, {0, 0, 1}}},
        {"eye on the plane, looking away", m, {0, 0, -1}, {m, {0, 0, 1}}},
        {"eye in the removed region", m + glm::dvec3(0, 0, 3), {0.1, 0, -1}, {m, {0, 0, 1}}},
        {"eye in the kept region", m - glm::dvec3(0, 0, 3), {0.1, 0, 1}, {m, {0, 0, 1}}},
        {"plane across the view", m + glm::dvec3(0, 0, 40), {0, 0, -1}, {m, {0, 0, 1}}},
        {"plane along the view", m + glm::dvec3(0, 0, 40), {0, 0, -1}, {m, {1, 0, 0}}},
        {"normal very long", m + glm::dvec3(0, 0, 40), {0, 0, -1}, {m, {1e100, 1e100, 0}}},
        {"normal very short", m + glm::dvec3(0, 0, 40), {0, 0, -1}, {m, {1e-100, 0, 1e-100}}},
        {"point very far", m + glm::dvec3(0, 0, 40), {0, 0, -1}, {m + glm::dvec3(1e12, 0, 0), {0, 0, 1}}},
    };
    for (const Place& place : places) {
        for (const double extinction : {0.2, 5.0}) {
            for (const bool removed : {false, true}) {
                for (const SheetCut sheets : {SheetCut::Whole, SheetCut::Sliced}) {
                    Shot shot;
                    shot.volume = ball();
                    shot.scene = two_tone(0, extinction);
                    shot.scene.lights = {Light{}};
                    shot.settings.sheets = sheets;
                    shot.settings.sheet_spacing = 0.5;
                    (removed ? shot.scene.effects.clip.remove : shot.scene.effects.clip.keep) = {place.plane};
                    shot.camera = look(*shot.volume, place.eye, place.eye + place.towards, 50, {0.1, 1, 0.05});
                    shot.width = shot.height = 10;
                    const RenderResult r = render(shot, {true, true, true, true});
                    const std::string what =
                        fmt::format("{}, {}, {}", place.name, removed ? "removed" : "kept", name_of(sheets));
                    EXPECT_TRUE(within(r.color, 0, 1.001F)) << what;
                    EXPECT_TRUE(shows_its_matter(r.color, *r.tau)) << what;
                    EXPECT_TRUE(within(*r.tau, 0, 1e3F)) << what;
                    EXPECT_TRUE(within(*r.depth, -3, 1e3F)) << what;
                    EXPECT_TRUE(within(*r.normal, -1.0001F, 1.0001F)) << what;
                    EXPECT_TRUE(within(*r.distance, -4, 4)) << what;
                }
            }
        }
    }
}

// From the plane itself, the ray's matter begins at the eye.
TEST(Clip, ShowsTheRestOfTheRayFromAnEyeOnThePlane) {
    Shot shot = block();
    const glm::dvec3 eye(11.5, 11.2, 9.3);
    shot.scene.effects.clip.keep = {beyond(eye, {0, 0, 1})};
    shot.width = shot.height = 16;
    shot.camera = look(*shot.volume, eye, eye - glm::dvec3(0, 0, 1), 40, {0, 1, 0});
    const Image tau = render_tau(shot);
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x)
            // The block ends half a voxel beyond its last samples.
            EXPECT_NEAR(static_cast<double>(tau.at(x, y, 0)) * std::abs(ray_of(shot, x, y).z), 0.05 * 9.8, 5e-4);
}

// Anisotropic, oblique, left-handed grid: planes are given in world space.
TEST(Clip, PlanesAreInWorldSpaceForEveryGrid) {
    const glm::dmat3 oblique(glm::dvec3(0.9, 0.2, 0.1), glm::dvec3(0.2, -1.1, 0.15), glm::dvec3(0.1, 0.3, 2.7));
    Shot shot = block();
    shot.volume = placed(shot.volume, oblique, {-40, 12, 7});
    const glm::dvec3 middle = shot.volume->geometry.to_world(glm::dvec3(11.5));
    const glm::dvec3 n = glm::normalize(glm::dvec3(0.2, 1, 0.3));
    shot.scene.effects.clip.keep = {beyond(middle + 1.5 * n, n), beyond(middle - 1.5 * n, -n)};
    shot.camera.eye = middle + glm::dvec3(20, 90, 10);
    shot.camera.direction = middle - shot.camera.eye;
    shot.camera.fov_y = 4;
    const Image tau = render_tau(shot);
    for (int y = 6; y < 18; ++y) {
        for (int x = 6; x < 18; ++x) {
            const double length = 3 / std::abs(glm::dot(ray_of(shot, x, y), n));
            EXPECT_NEAR(static_cast<double>(tau.at(x, y, 0)), 0.05 * length, 2e-4);
        }
    }
}

TEST(Clip, PlanesMoveWithoutRecollectionIfNothingIsBuried) {
    Shot shot;
    shot.volume = ball();
    shot.scene = two_tone(0, 0.1);
    shot.scene.effects.clip.keep = {beyond(kMiddle, {0, 0, 1})};
    shot.camera = look(*shot.volume, {60, -80, 40}, kMiddle, 20);
    const auto first = render(shot).stats;
    shot.scene.effects.clip.keep[0].point.z += 1;
    EXPECT_EQ(render(shot).stats.setup_milliseconds, 0);
    // In opaque matter the cut exposes buried voxels.
    shot.scene.materials[1].extinction = 3;
    render(shot);
    shot.scene.effects.clip.keep[0].point.z -= 2;
    const RenderResult opaque = render(shot);
    EXPECT_GT(opaque.stats.setup_milliseconds, 0);
    EXPECT_LT(opaque.stats.splats_collected, first.splats_collected);
    shot.settings.cull_buried = false;
    EXPECT_LE(compare_images(render(shot).color, opaque.color).max, 0.01);
}

}  // namespace
}  // namespace edgesplat::test

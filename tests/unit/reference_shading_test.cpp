// Light on surfaces and in translucent matter, and pixels beside outlines: one source for shaders and reference,
// against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "engine/reference/face_geometry.h"
#include "engine/reference/outlines.h"
#include "engine/reference/shading.h"

namespace edgesplat::reference {
namespace {

using glm::dvec3;
using glm::dvec4;

constexpr dvec3 kEye(0, 0, 100);
constexpr dvec3 kColor(0.9, 0.6, 0.3);

/// Unit vector in the plane of x and z, turned from z by an angle in degrees.
dvec3 turned(double degrees) {
    const double angle = degrees * std::numbers::pi / 180;
    return {std::sin(angle), 0, std::cos(angle)};
}

Scene lit_by(std::vector<Light> lights) {
    Scene scene;
    scene.ambient = 0.2;
    scene.lights = std::move(lights);
    return scene;
}

Light light_of(Light::Kind kind, const dvec3& where, double intensity, const dvec3& color = dvec3(1)) {
    Light light;
    light.kind = kind;
    light.direction = light.position = where;
    light.intensity = intensity;
    light.color = color;
    return light;
}

void expect_color(const dvec3& got, const dvec3& want) {
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(got[c], want[c], 1e-12);
}

TEST(ShadedSurfaces, FollowTheCosine) {
    const Scene head = lit_by({light_of(Light::Kind::Headlight, {}, 0.7)});
    const Scene far = lit_by({light_of(Light::Kind::Directional, 5.0 * turned(20), 0.7, {1, 0.5, 0})});
    for (const double angle : {0.0, 35.0, 60.0}) {
        const Surface seen{.color = kColor, .normal = turned(angle)};
        expect_color(shade(head, seen, kEye), kColor * (0.2 + 0.7 * turned(angle).z));
        expect_color(shade(far, seen, kEye), kColor * (0.2 + 0.7 * turned(angle - 20).z * dvec3(1, 0.5, 0)));
    }
    expect_color(shade(far, {.color = kColor, .normal = turned(150)}, kEye), kColor * 0.2);
    expect_color(shade(head, {.color = kColor}, kEye), kColor * (0.2 + 0.5 * 0.7));
    expect_color(shade(lit_by({}), {.color = kColor, .normal = turned(40)}, kEye), kColor);
}

TEST(ShadedSurfaces, AreLitByNearLights) {
    const dvec3 place(3, 0, 4);
    const Scene near = lit_by({light_of(Light::Kind::Point, place, 1)});
    expect_color(shade(near, {.color = kColor, .normal = {0, 0, 1}}, kEye), kColor * (0.2 + 0.8));
    // At the light itself.
    expect_color(shade(near, {.color = kColor, .normal = {0, 0, 1}, .position = place}, kEye), kColor * 1.2);
}

TEST(ShadedSurfaces, ShareEachLight) {
    const Scene two = lit_by({light_of(Light::Kind::Headlight, {}, 0.5, {1, 0, 0}),
                              light_of(Light::Kind::Directional, {0, 0, 1}, 0.4, {0, 1, 0})});
    const Reach reach{.ambient = 0.5, .lights = {0.25, 1, 1, 1}};
    const Surface seen{.color = dvec3(1), .response = {.ambient = 2, .diffuse = 0.8}, .normal = {0, 0, 1}};
    expect_color(shade(two, seen, kEye, reach), dvec3(0.2) + 0.8 * dvec3(0.5 * 0.25, 0.4, 0));
}

TEST(ShadedSurfaces, ShineAlongTheHalfwayVector) {
    const LightResponse glossy{.ambient = 0, .diffuse = 0, .specular = 0.6, .shininess = 12};
    const Scene far = lit_by({light_of(Light::Kind::Directional, turned(40), 0.5)});
    // The eye sees z; the halfway vector is turned by 20 degrees.
    for (const double angle : {-30.0, 0.0, 20.0, 75.0}) {
        const Surface seen{.color = kColor, .response = glossy, .normal = turned(angle)};
        expect_color(shade(far, seen, kEye), dvec3(0.6 * 0.5 * std::pow(turned(angle - 20).z, 12)));
    }
    // Turned away from the light, though not from the halfway vector.
    expect_color(shade(far, {.color = kColor, .response = glossy, .normal = turned(-55)}, kEye), dvec3(0));
    expect_color(shade(far, {.color = kColor, .response = glossy}, kEye), dvec3(0));
}

TEST(ShadedSurfaces, HaveSilhouettesAndFog) {
    Scene scene = lit_by({});
    scene.effects.silhouette = {.color = {0, 0, 1}, .strength = 0.8, .sharpness = 3};
    for (const double angle : {0.0, 60.0, 90.0, 120.0}) {
        const double share = 0.8 * std::pow(1 - std::abs(turned(angle).z), 3);
        expect_color(shade(scene, {.color = kColor, .normal = turned(angle)}, kEye),
                     (1 - share) * kColor + share * dvec3(0, 0, 1));
    }
    expect_color(shade(scene, {.color = kColor}, kEye), kColor);
    scene.effects.silhouette.reset();
    scene.effects.fog = {.color = {1, 1, 1}, .density = 0.03, .start = 20};
    for (const double depth : {5.0, 20.0, 50.0}) {
        const double clear = std::exp(-0.03 * std::max(depth - 20, 0.0));
        expect_color(shade(scene, {.color = kColor, .depth = depth}, kEye), clear * kColor + (1 - clear) * dvec3(1));
    }
}

/// Share of the farther half in the absorption of a path, by numbers.
double farther_share(double absorbs, double length) {
    constexpr int kSteps = 20000;
    double half[2] = {0, 0};
    for (int i = 0; i < kSteps; ++i)
        half[2 * i / kSteps] += std::exp(-absorbs * length * (i + 0.5) / kSteps);
    return half[1] / (half[0] + half[1]);
}

TEST(LitPaths, EndWithinMostOfTheKernelAndAtTheBorder) {
    geometry::FaceGeometry at;
    constexpr double kWithin = geometry::LIT_WITHIN;
    const Quadratic none{1, 0, 0};
    const auto whole = at.lit_path(-3, 2.5, false, 9, 2, 1.7, false, none);
    EXPECT_DOUBLE_EQ(whole.near, -2 * kWithin);
    EXPECT_DOUBLE_EQ(whole.far, 2 * kWithin);
    EXPECT_FALSE(whole.to_border);
    EXPECT_NEAR(whole.share, farther_share(1.7, 4 * kWithin), 1e-6);
    const auto inner = at.lit_path(-0.5, 0.25, false, 9, 2, 4, false, none);
    EXPECT_DOUBLE_EQ(inner.near, -0.5);
    EXPECT_DOUBLE_EQ(inner.far, 0.25);
    EXPECT_NEAR(inner.share, farther_share(4, 0.75), 1e-6);
    const auto bordered = at.lit_path(-1.9, 2.5, true, 0.5, 2, 1, false, none);
    EXPECT_DOUBLE_EQ(bordered.near, -1.9);
    EXPECT_DOUBLE_EQ(bordered.far, 0.5);
    EXPECT_TRUE(bordered.to_border);
}

TEST(LitPaths, OfLayersEndAtBothFaces) {
    geometry::FaceGeometry at;
    // (z + 1.5) (z - 1.7), and the same so far away that it lights nothing.
    const Quadratic faces{-1.5 * 1.7, -0.2, 1}, farther{-4.0 * 1.7, 2.3, 1};
    const auto layer = at.lit_path(-0.4, 0.6, false, 9, 2, 1, true, faces);
    EXPECT_NEAR(layer.near, -1.5, 1e-12);
    EXPECT_NEAR(layer.far, 1.7, 1e-12);
    const auto at_borders = at.lit_path(-0.4, 0.6, true, 0.5, 2, 1, true, faces);
    EXPECT_DOUBLE_EQ(at_borders.near, -0.4);
    EXPECT_DOUBLE_EQ(at_borders.far, 0.5);
    for (const Quadratic& phi : {farther, Quadratic{0.2, 0.5, 1}}) {
        const auto alone = at.lit_path(-0.4, 0.6, false, 9, 2, 1, true, phi);
        EXPECT_DOUBLE_EQ(alone.near, -0.4);
        EXPECT_DOUBLE_EQ(alone.far, 0.6);
    }
}

TEST(OutlinePlaces, LieAlongTheSteeperAxis) {
    const auto down = geometry::outline_place(0.6, {1, -2});
    EXPECT_TRUE(down.there && down.down);
    EXPECT_DOUBLE_EQ(down.level, 0.3);
    EXPECT_DOUBLE_EQ(down.offset, 0.3);
    const auto right = geometry::outline_place(-0.6, {-2, 1});
    EXPECT_TRUE(right.there && !right.down);
    EXPECT_DOUBLE_EQ(right.level, -0.3);
    EXPECT_DOUBLE_EQ(right.offset, -0.3);
    EXPECT_FALSE(geometry::outline_place(2.1, {-2, 1}).there);
}

TEST(PixelsAtOutlines, ShowTheShareOfBothSides) {
    constexpr int kWidth = 9, kHeight = 7;
    const dvec4 inner(0.8, 0.6, 0.1, 1), outer(0.1, 0.2, 0.5, 0.25);
    for (const bool down : {false, true}) {
        for (const double offset : {0.2, 0.5, 0.8, -0.3, -0.9}) {
            SCOPED_TRACE(testing::Message() << (down ? "down " : "right ") << offset);
            // Matter up to the outline, which passes beside pixel 3.
            const auto along = [&](int x, int y) { return down ? y : x; };
            std::vector<dvec4> frame;
            std::vector<std::optional<Outline>> outlines(std::size_t{kWidth} * kHeight);
            for (int y = 0; y < kHeight; ++y)
                for (int x = 0; x < kWidth; ++x) {
                    if (along(x, y) == 3) outlines[frame.size()] = Outline{-offset, offset, down};
                    frame.push_back(along(x, y) < 3 + offset ? inner : outer);
                }
            const auto smooth = smoothed(frame, outlines, kWidth, kHeight);
            for (int y = 0; y < kHeight; ++y)
                for (int x = 0; x < kWidth; ++x) {
                    const double share = std::clamp(3 + offset - along(x, y) + 0.5, 0.0, 1.0);
                    const dvec4 want = share * inner + (1 - share) * outer;
                    const dvec4 got = smooth[static_cast<std::size_t>(y * kWidth + x)];
                    for (int c = 0; c < 4; ++c)
                        EXPECT_NEAR(got[c], want[c], 1e-12) << x << ", " << y;
                }
        }
    }
}

TEST(PixelsAtOutlines, DoNotChangeASmoothPicture) {
    constexpr int kWidth = 8, kHeight = 6;
    std::vector<dvec4> frame;
    std::vector<std::optional<Outline>> outlines(std::size_t{kWidth} * kHeight);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            if (x == 3) outlines[frame.size()] = Outline{0.2, 0.2, false};
            frame.emplace_back(0.1 * x, 0.05 * y, 0.02 * (x + y), 1);
        }
    const auto smooth = smoothed(frame, outlines, kWidth, kHeight);
    for (std::size_t i = 0; i < frame.size(); ++i)
        for (int c = 0; c < 4; ++c)
            EXPECT_NEAR(smooth[i][c], frame[i][c], 1e-12);
}

}  // namespace
}  // namespace edgesplat::reference

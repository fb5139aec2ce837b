// Named views: they show the whole volume upright, and `close` is near a surface.
#include "engine/scene/views.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "engine/error.h"

namespace edgesplat {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// Anisotropic, oblique, left-handed, far from the origin; a box of value 1 inside.
Volume oblique_volume() {
    Volume volume;
    volume.geometry.dims = {20, 30, 10};
    volume.geometry.index_to_world_axes = {glm::dvec3(0.8, 0.6, 0), glm::dvec3(-0.6, 0.8, 0), glm::dvec3(0, 0, -3)};
    volume.geometry.origin = {100, -50, 7};
    volume.values.assign(volume.geometry.voxel_count(), 0.0F);
    for (int z = 3; z < 7; ++z)
        for (int y = 8; y < 22; ++y)
            for (int x = 5; x < 15; ++x)
                volume.values[static_cast<std::size_t>((z * 30 + y) * 20 + x)] = 1;
    volume.max_value = 1;
    return volume;
}

const Scene& surface_scene() {
    static const Scene kScene{{0.5}, {Material{}, Material{{1, 1, 1}, 8}}, {}, {}};
    return kScene;
}

/// Picture position of a world point, -1..1 across the frame.
glm::dvec2 project(const Camera& camera, const glm::dvec3& world, double aspect) {
    const CameraFrame frame = camera_frame(camera);
    const glm::dvec3 p = world - frame.eye;
    const double z = glm::dot(p, frame.forward);
    EXPECT_GT(z, 0);
    return {glm::dot(p, frame.right) / (z * frame.tan_half_y * aspect), glm::dot(p, frame.up) / (z * frame.tan_half_y)};
}

TEST(SceneViews, EveryViewShowsTheWholeVolume) {
    const Volume volume = oblique_volume();
    for (const glm::ivec2 size : {glm::ivec2(512, 512), glm::ivec2(640, 200), glm::ivec2(100, 400)}) {
        for (const std::string_view name : view_names()) {
            if (name == "close") continue;
            const Camera camera = named_view(name, {&volume, &surface_scene(), 40, size.x, size.y});
            double most = 0;
            for (int corner = 0; corner < 8; ++corner) {
                const glm::dvec3 index =
                    glm::dvec3(corner & 1, (corner >> 1) & 1, corner >> 2) * glm::dvec3(volume.geometry.dims) - 0.5;
                const glm::dvec2 p = project(camera, volume.geometry.to_world(index), double(size.x) / size.y);
                most = std::max({most, std::abs(p.x), std::abs(p.y)});
            }
            EXPECT_LE(most, 1) << name;
            EXPECT_GE(most, 0.9) << name << " should fill the picture";
        }
    }
}

TEST(SceneViews, FillThePictureWithThinMatter) {
    struct Thin {
        const char* name;
        glm::ivec3 dims, low, high;  // the matter's first and last voxel
    };
    for (const Thin& thin :
         {Thin{"one slice", {30, 20, 1}, {6, 5, 0}, {15, 12, 0}}, Thin{"sheet", {30, 20, 18}, {6, 5, 7}, {15, 12, 7}},
          Thin{"row", {30, 20, 18}, {6, 5, 7}, {15, 5, 7}}, Thin{"voxel", {30, 20, 18}, {6, 5, 7}, {6, 5, 7}},
          Thin{"cube", {30, 20, 18}, {6, 5, 7}, {15, 12, 14}}}) {
        Volume volume;
        volume.geometry.dims = thin.dims;
        volume.values.assign(volume.geometry.voxel_count(), 0.0F);
        for (int z = thin.low.z; z <= thin.high.z; ++z)
            for (int y = thin.low.y; y <= thin.high.y; ++y)
                for (int x = thin.low.x; x <= thin.high.x; ++x)
                    volume.values[static_cast<std::size_t>(x + thin.dims.x * (y + thin.dims.y * z))] = 1;
        finish_volume(volume);
        for (const std::string_view name : {"front", "top", "oblique"}) {
            const Camera camera = named_view(name, {&volume, &surface_scene(), 40, 200, 200, true});
            double most = 0;
            for (int corner = 0; corner < 8; ++corner) {
                const glm::dvec3 up(corner & 1, (corner >> 1) & 1, corner >> 2);
                const glm::dvec3 at = glm::mix(glm::dvec3(thin.low) - 0.5, glm::dvec3(thin.high) + 0.5, up);
                const glm::dvec2 p = project(camera, volume.geometry.to_world(at), 1);
                most = std::max({most, std::abs(p.x), std::abs(p.y)});
            }
            EXPECT_LE(most, 1) << thin.name << ", " << name;
            EXPECT_GE(most, 0.9) << thin.name << ", " << name;
        }
    }
}

TEST(SceneViews, DirectionsFollowPatientAxes) {
    const Volume volume = oblique_volume();
    const glm::dvec3 center = volume.geometry.to_world((glm::dvec3(volume.geometry.dims) - 1.0) / 2.0);
    const auto view = [&](std::string_view name) { return named_view(name, {&volume, &surface_scene(), 45, 64, 64}); };
    EXPECT_LT(view("front").eye.y, center.y);
    EXPECT_GT(view("left").eye.x, center.x);
    EXPECT_GT(view("top").eye.z, center.z);
    EXPECT_GT(project(view("front"), center + glm::dvec3(0, 0, 1), 1).y, 0) << "+z is up";
    EXPECT_GT(project(view("front"), center + glm::dvec3(1, 0, 0), 1).x, 0) << "the patient's left is on the right";
    EXPECT_GT(project(view("top"), center + glm::dvec3(0, -1, 0), 1).y, 0) << "anterior is up";
}

TEST(SceneViews, CloseShowsAVoxelAtTwentyPixelsOrMore) {
    const Volume volume = oblique_volume();
    const int height = 300;
    const Camera camera = named_view("close", {&volume, &surface_scene(), 50, 300, height});
    // Marches along the central ray to the box and computes the size of a voxel (1 mm) there, in pixels.
    for (double t = 0;; t += 0.05) {
        ASSERT_LT(t, 200) << "the central ray misses the box";
        const glm::ivec3 i(glm::round(volume.geometry.to_index(camera.eye + t * glm::normalize(camera.direction))));
        if (glm::any(glm::lessThan(i, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(i, volume.geometry.dims)))
            continue;
        if (volume.at(i.x, i.y, i.z) == 0) continue;
        EXPECT_GE(height / (2 * t * std::tan(glm::radians(25.0))), 20);
        EXPECT_GT(t, 1);
        break;
    }
}

/// A small box in one corner of an empty volume, and one noise voxel in another corner.
Volume corner_volume() {
    Volume volume;
    volume.geometry.dims = {60, 50, 40};
    volume.name = "corner";
    volume.values.assign(volume.geometry.voxel_count(), 0.0F);
    for (int z = 2; z < 10; ++z)
        for (int y = 3; y < 12; ++y)
            for (int x = 40; x < 56; ++x)
                volume.values[static_cast<std::size_t>((z * 50 + y) * 60 + x)] = 1;
    volume.values.front() = 1;
    volume.max_value = 1;
    return volume;
}

TEST(SceneViews, VisibleMatterFillsPicture) {
    const Volume volume = corner_volume();
    for (const glm::ivec2 size : {glm::ivec2(512, 512), glm::ivec2(640, 200), glm::ivec2(100, 400)}) {
        for (const std::string_view name : view_names()) {
            if (name == "close") continue;
            ViewRequest request{&volume, &surface_scene(), 40, size.x, size.y, true};
            const Camera camera = named_view(name, request);
            glm::dvec2 low(9), high(-9);
            for (int corner = 0; corner < 8; ++corner) {
                const glm::dvec3 index = glm::mix(glm::dvec3(39.5, 2.5, 1.5), glm::dvec3(55.5, 11.5, 9.5),
                                                  glm::dvec3(corner & 1, (corner >> 1) & 1, corner >> 2));
                const glm::dvec2 p = project(camera, volume.geometry.to_world(index), double(size.x) / size.y);
                low = glm::min(low, p);
                high = glm::max(high, p);
            }
            EXPECT_GE(std::min(low.x, low.y), -1) << name;
            EXPECT_LE(std::max(high.x, high.y), 1) << name;
            EXPECT_GE(std::max(high.x - low.x, high.y - low.y), 1.7) << name << " should fill the picture";
            EXPECT_NEAR(low.x, -high.x, 0.2) << name << " should be in the middle";
            EXPECT_NEAR(low.y, -high.y, 0.2) << name;
            // Without `fill` the view frames the whole volume, so the eye is farther away.
            request.fill = false;
            EXPECT_GT(glm::length(named_view(name, request).eye - volume.geometry.center()),
                      glm::length(camera.eye - volume.geometry.to_world({47.5, 7, 5.5})));
        }
    }
}

TEST(SceneViews, CloseFindsSurfaceBesideCentralRay) {
    // A tube along the line of sight: the central ray passes through it without a hit.
    Volume volume;
    volume.geometry.dims = glm::ivec3(40);
    volume.name = "tube";
    for (int z = 0; z < 40; ++z)
        for (int y = 0; y < 40; ++y)
            for (int x = 0; x < 40; ++x) {
                const double r = glm::length(glm::dvec2(x, z) - 19.5);
                volume.values.push_back(y > 4 && y < 35 && r > 6 && r < 15 ? 1.0F : 0.0F);
            }
    volume.max_value = 1;
    const Camera camera = named_view("close", {&volume, &surface_scene(), 45, 300, 300, true});
    const glm::dvec3 forward = glm::normalize(camera.direction);
    const double near = 300 / (2 * std::tan(glm::radians(22.5)) * 24);
    for (double t = 0;; t += 0.1) {
        ASSERT_LT(t, near + 2) << "the central ray meets nothing";
        const glm::ivec3 i(glm::round(camera.eye + t * forward));
        if (glm::any(glm::lessThan(i, glm::ivec3(0))) || glm::any(glm::greaterThan(i, glm::ivec3(39)))) continue;
        if (volume.at(i.x, i.y, i.z) == 0) continue;
        EXPECT_NEAR(t, near, 1);
        EXPECT_EQ(i.y, 5) << "the end face of the tube, not its inner wall";
        break;
    }
}

/// 40 x 70 x 40 voxels; `inside` is a distance in voxels, > 0 in matter.
template <typename Inside>
Volume volume_of(const Inside& inside) {
    Volume volume;
    volume.geometry.dims = {40, 70, 40};
    for (int z = 0; z < 40; ++z)
        for (int y = 0; y < 70; ++y)
            for (int x = 0; x < 40; ++x)
                volume.values.push_back(static_cast<float>(std::clamp(0.5 + inside(glm::dvec3(x, y, z)), 0.0, 1.0)));
    volume.max_value = 1;
    return volume;
}

std::string_view best_view(const Volume& volume) {
    return most_informative_view({&volume, &surface_scene(), 45, 300, 300, true});
}

TEST(SceneViews, BestViewShowsObjectsSideBySide) {
    const auto ball = [](const glm::dvec3& p, double y) { return 13 - glm::length(p - glm::dvec3(19.5, y, 19.5)); };
    EXPECT_EQ(best_view(volume_of([&](const glm::dvec3& p) { return ball(p, 20); })), "front");
    EXPECT_NE(best_view(volume_of([&](const glm::dvec3& p) { return std::max(ball(p, 15), ball(p, 50)); })), "front");
}

TEST(SceneViews, BestViewIgnoresCutFaces) {
    // Half a ball of rough matter, with its cut towards the front.
    Volume half = volume_of([](const glm::dvec3& p) { return 18 - glm::length(p - glm::dvec3(19.5, 0, 19.5)); });
    for (std::size_t i = 0; i < half.values.size(); ++i)
        if (half.values[i] >= 1) half.values[i] = 0.7F + 0.3F * static_cast<float>(i * 7919 % 101) / 101;
    EXPECT_NE(best_view(half), "front");
}

TEST(SceneViews, UnknownNameListsKnownNames) {
    const Volume volume = oblique_volume();
    EXPECT_THAT(
        [&] {
            named_view("frnt", {&volume, &surface_scene(), 45, 64, 64});
        },
        ThrowsMessage<Error>(::testing::AllOf(HasSubstr("'frnt'"), HasSubstr("front, back"))));
}

TEST(SceneViews, VolumeAxesAreDirectionCosines) {
    const glm::dmat3 axes = volume_axes(oblique_volume().geometry);
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(glm::length(axes[i]), 1, 1e-12);
    EXPECT_NEAR(axes[2].z, -1, 1e-12);
}

}  // namespace
}  // namespace edgesplat

// Dragging clip planes and boxes by their handles.
#include "engine/viewer/handles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/unit/viewer_random.h"
#include "tests/unit/viewer_volumes.h"

namespace edgesplat::viewer {
namespace {

using namespace viewer_test;

constexpr glm::ivec2 kSize{640, 400};

Camera looking(const glm::dvec3& eye, const glm::dvec3& at) {
    return {eye, at - eye, {0, 0, 1}, 45};
}

VolumeGeometry geometry() {
    return sampled(straight_tube())->geometry;  // turned about all axes
}

TEST(Handles, FindPointOnLineNearestToRay) {
    Random random(11);
    for (int i = 0; i < 2000; ++i) {
        const Ray ray{100.0 * random.direction(), random.direction()};
        const glm::dvec3 origin = 100.0 * random.direction(), along = random.direction();
        const auto t = along_line(ray, origin, along);
        if (!t) continue;
        const auto distance = [&](double at) {
            const glm::dvec3 way = origin + at * along - ray.origin;
            return glm::length(way - glm::dot(way, ray.direction) * ray.direction);
        };
        const double found = distance(*t);
        for (const double step : {1e-3, 1.0, 50.0})
            EXPECT_LE(found, std::min(distance(*t - step), distance(*t + step)) + 1e-9);
        EXPECT_GT(glm::dot(origin + *t * along - ray.origin, ray.direction), 0);
    }
}

TEST(Handles, DragMovesExactlyToRay) {
    Random random(11);
    for (int i = 0; i < 500; ++i) {
        const Camera camera = looking(200.0 * random.direction(), 20.0 * random.direction());
        const glm::dvec3 origin = 20.0 * random.direction(), along = random.direction();
        const double wanted = random(-30, 30);
        const auto pixel = project(camera, kSize, origin + wanted * along);
        ASSERT_TRUE(pixel);
        const auto t = along_line(pixel_ray(camera, kSize, *pixel), origin, along);
        const double cosine = glm::dot(along, glm::normalize(origin - camera.eye));
        if (std::abs(cosine) > 0.99) continue;
        ASSERT_TRUE(t);
        EXPECT_NEAR(*t, wanted, 1e-8);
    }
}

TEST(Handles, RefuseParallelRaysAndPointsBehindEye) {
    const Ray ray{{0, 0, 0}, {0, 1, 0}};
    EXPECT_FALSE(along_line(ray, {5, 5, 5}, {0, 1, 0}));
    EXPECT_FALSE(along_line(ray, {5, 5, 5}, {0, -1, 0}));
    EXPECT_FALSE(along_line(ray, {5, 5, 5}, glm::normalize(glm::dvec3(-5e-4, 1, 0))));
    EXPECT_TRUE(along_line(ray, {5, 5, 5}, glm::normalize(glm::dvec3(-5e-3, 1, 0))));
    EXPECT_FALSE(along_line(ray, {5, -5, 5}, {1, 0, 0}));  // behind the eye
    EXPECT_EQ(along_line(ray, {5, 5, 5}, {1, 0, 0}), -5);
}

TEST(Handles, DragIsAlwaysFinite) {
    Random random(11);
    const VolumeGeometry g = geometry();
    SceneDocument d;
    d.effects.clip.keep = {{{1, 2, 3}, {0.1, -2, 0.4}}};
    d.keep_box = volume_box(g);
    for (int i = 0; i < 3000; ++i) {
        const auto handles = clip_handles(d, g);
        ASSERT_EQ(handles.size(), 7U);
        const Handle& handle = handles[static_cast<std::size_t>(random(0, 7))];
        const Camera camera = looking(handle.place + random(0, 1) * 300.0 * random.direction() + 1e-6, handle.place);
        const glm::dvec2 pixel(random(-5000, 5000), random(-5000, 5000));
        if (const auto t = along_line(pixel_ray(camera, kSize, pixel), handle.place, handle.normal))
            move_handle(d, g, handle, *t);
        const Plane& plane = d.effects.clip.keep[0];
        ASSERT_TRUE(std::isfinite(glm::dot(plane.point, plane.point)));
        ASSERT_TRUE(glm::all(glm::lessThan(d.keep_box->low, d.keep_box->high)));
        ASSERT_TRUE(std::isfinite(glm::dot(d.keep_box->low, d.keep_box->high)));
    }
    const SceneDocument before = d;
    for (const Handle& handle : clip_handles(d, g)) {
        move_handle(d, g, handle, std::numeric_limits<double>::quiet_NaN());
        move_handle(d, g, handle, std::numeric_limits<double>::infinity());
    }
    EXPECT_EQ(d, before);
}

TEST(Handles, LieOnTheirPlanes) {
    const VolumeGeometry g = geometry();
    SceneDocument d;
    d.effects.clip.keep = {{{1, 2, 3}, {0.1, -2, 0.4}}, {{5, 5, 5}, {0, 0, 1e-200}}};
    d.keep_box = ClipBox{{1, 2, 3}, {10, 20, 30}};
    d.remove_box = ClipBox{{-1, -2, -3}, {1, 2, 3}};
    const auto handles = clip_handles(d, g);
    ASSERT_EQ(handles.size(), 14U);
    for (const std::size_t i : {0U, 1U}) {
        const Plane& plane = d.effects.clip.keep[i];
        EXPECT_NEAR(glm::length(handles[i].normal), 1, 1e-12);
        EXPECT_NEAR(glm::dot(handles[i].place - plane.point, handles[i].normal), 0, 1e-9);
    }
    EXPECT_EQ(handles[2].kind, Handle::Kind::KeepBox);
    EXPECT_EQ(handles[2].place, glm::dvec3(1, 11, 16.5));
    EXPECT_EQ(handles[2].normal, glm::dvec3(-1, 0, 0));
    EXPECT_EQ(handles[7].place, glm::dvec3(5.5, 11, 30));
    EXPECT_EQ(handles[13].kind, Handle::Kind::RemoveBox);
    EXPECT_EQ(handles[13].index, 5U);
}

TEST(Handles, PlaneMovesByDistanceAndStopsAtVolume) {
    const VolumeGeometry g = geometry();
    SceneDocument d;
    d.effects.clip.keep = {{g.to_world({20, 20, 20}), {0.3, 0.2, -1}}};
    const Handle handle = clip_handles(d, g).at(0);
    move_handle(d, g, handle, 4.25);
    EXPECT_NEAR(glm::dot(clip_handles(d, g)[0].place - handle.place, handle.normal), 4.25, 1e-9);
    EXPECT_EQ(d.effects.clip.keep[0].normal, glm::dvec3(0.3, 0.2, -1));
    // At its limits the plane cuts nothing or everything: a corner of the volume touches it.
    for (const double far : {-1e6, 1e6}) {
        move_handle(d, g, handle, far);
        double least = 1e9, most = -1e9;
        for (int c = 0; c < 8; ++c) {
            const glm::dvec3 corner(c & 1, c >> 1 & 1, c >> 2 & 1);
            const double t =
                glm::dot(g.to_world(corner * glm::dvec3(g.dims) - 0.5) - d.effects.clip.keep[0].point, handle.normal);
            least = std::min(least, t);
            most = std::max(most, t);
        }
        EXPECT_NEAR(far < 0 ? least : most, 0, 1e-9);
    }
}

TEST(Handles, BoxSidesMoveIndependentlyAndNeverMeet) {
    const VolumeGeometry g = geometry();
    const ClipBox bounds = volume_box(g);
    SceneDocument d;
    d.keep_box = bounds;
    for (const Handle& handle : clip_handles(d, g)) {
        const int axis = static_cast<int>(handle.index / 2);
        SceneDocument moved = d;
        move_handle(moved, g, handle, -3);
        ClipBox expected = bounds;
        (handle.index % 2 == 1 ? expected.high : expected.low)[axis] -= 3 * handle.normal[axis];
        EXPECT_EQ(moved.keep_box, expected);
        move_handle(moved, g, handle, 1e5);
        EXPECT_EQ(moved.keep_box, bounds);
        move_handle(moved, g, handle, -1e5);
        EXPECT_NEAR(moved.keep_box->high[axis] - moved.keep_box->low[axis], 0.5, 1e-9);
    }
    d.remove_box = ClipBox{bounds.low - 10.0, bounds.high};
    for (const Handle& handle : clip_handles(d, g))
        if (handle.kind == Handle::Kind::RemoveBox) move_handle(d, g, handle, 5);
    EXPECT_EQ(d.remove_box->low, bounds.low - 10.0);
    EXPECT_EQ(d.keep_box, bounds);
}

TEST(Handles, VolumeBoxContainsEveryCorner) {
    VolumeGeometry g;
    g.dims = {4, 6, 8};
    g.index_to_world_axes = glm::dmat3(0.5);
    g.origin = {1, 2, 3};
    EXPECT_EQ(volume_box(g), (ClipBox{{0.75, 1.75, 2.75}, {2.75, 4.75, 6.75}}));
}

TEST(Handles, NearestHandleInPictureIsPicked) {
    const Camera camera = looking({0, -100, 0}, {0, 0, 0});
    std::vector<Handle> handles(3);
    handles[0].place = {0, 0, 0};
    handles[1].place = {1, 0, 0};
    handles[2].place = {0, -200, 0};  // behind the eye
    const glm::dvec2 middle = glm::dvec2(kSize) / 2.0;
    EXPECT_EQ(handle_at(handles, camera, kSize, middle, 8, 0), 0U);
    EXPECT_EQ(handle_at(handles, camera, kSize, *project(camera, kSize, {0.9, 0, 0}), 8, 0), 1U);
    EXPECT_FALSE(handle_at(handles, camera, kSize, middle + glm::dvec2(0, 9), 8, 0));
    // A handle beside the picture appears at its rim; a handle behind the eye does not appear.
    Camera aside = camera;
    aside.direction = glm::normalize(glm::normalize(camera.direction) + 3.0 * camera_frame(camera).right);
    const auto seen = handle_pixel(handles[0], aside, kSize, 12);
    ASSERT_TRUE(seen);
    EXPECT_EQ(seen->x, 12);
    EXPECT_EQ(handle_at({handles.data(), 1}, aside, kSize, *seen + glm::dvec2(3, 0), 8, 12), 0U);
    aside.direction = -camera.direction;
    EXPECT_FALSE(handle_pixel(handles[0], aside, kSize, 12));
    EXPECT_FALSE(handle_at({}, camera, kSize, middle, 8, 0));
}

TEST(Handles, DiscMappingIsInvertible) {
    Random random(11);
    EXPECT_EQ(disc_of({0, 0, 3}), glm::dvec2(0));
    EXPECT_NEAR(glm::length(disc_of({0, 0, -1})), 1, 1e-12);
    EXPECT_LT(glm::length(disc_of({2, 0, 0}) - glm::dvec2(0.5, 0)), 1e-12);
    EXPECT_LT(glm::length(direction_of({0, 0.5}) - glm::dvec3(0, 1, 0)), 1e-12);
    EXPECT_LT(glm::length(direction_of({0, -7}) - glm::dvec3(0, 0, -1)), 1e-12);
    for (int i = 0; i < 200; ++i) {
        const glm::dvec3 d = random.direction();
        EXPECT_LT(glm::length(direction_of(disc_of(d)) - d), 1e-12);
    }
}

}  // namespace
}  // namespace edgesplat::viewer

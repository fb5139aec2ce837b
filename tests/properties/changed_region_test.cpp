// A volume that differs from the previous one within a box: which edges are estimated again, and that the result equals
// one from scratch.
#include <gtest/gtest.h>

#include "engine/volume/changed_box.h"
#include "tests/properties/scenes.h"

namespace edgesplat::test {
namespace {

Renderer own_renderer() {
    return Renderer({.device = test_renderer().device().name, .validation = true});
}

/// An opaque torus in a translucent shell, in n^3 voxels.
Shot torus_of(int n) {
    Shot shot = torus_shot();
    const glm::dvec3 middle(0.47 * n);
    shot.volume = std::make_shared<const Volume>(sample(torus_scene(glm::ivec3(n), middle, 0.28 * n, 0.13 * n)));
    shot.camera = look(*shot.volume, {0.5 * n, -0.8 * n, 0.9 * n}, middle, 40);
    return shot;
}

/// The volume with a ball of `radius` voxels around `center` set to `value`.
std::shared_ptr<Volume> with_ball(const Volume& volume, const glm::dvec3& center, double radius, float value) {
    auto out = std::make_shared<Volume>(volume);
    const glm::ivec3 dims = volume.geometry.dims;
    std::size_t i = 0;
    for (int z = 0; z < dims.z; ++z)
        for (int y = 0; y < dims.y; ++y)
            for (int x = 0; x < dims.x; ++x, ++i)
                if (glm::length(glm::dvec3(x, y, z) - center) < radius) out->values[i] = value;
    finish_volume(*out);
    return out;
}

RenderResult picture(Renderer& renderer, const Shot& shot, const Settings& settings) {
    AovRequest outputs;
    outputs.depth = outputs.distance = true;
    return renderer.render(shot.scene, shot.camera, settings, 72, 56, outputs);
}

void expect_same(const RenderResult& a, const RenderResult& b) {
    EXPECT_EQ(a.stats.splats_collected, b.stats.splats_collected);
    EXPECT_EQ(a.stats.edge_splats, b.stats.edge_splats);
    EXPECT_TRUE(a.color.pixels == b.color.pixels);
    EXPECT_TRUE(a.depth->pixels == b.depth->pixels);
    EXPECT_TRUE(a.distance->pixels == b.distance->pixels);
}

struct Change {
    const char* name;
    glm::dvec3 center;
    double radius;
    float value;
};

TEST(ChangedRegion, MatchesPicturesFromScratch) {
    Shot shot = torus_of(48);
    for (const EdgeEstimator edges :
         {EdgeEstimator::March, EdgeEstimator::Taylor, EdgeEstimator::Cubic, EdgeEstimator::Off}) {
        Settings settings;
        settings.edges = edges;
        // On the spline, surface splats draw the core.
        shot.scene.materials.back().extinction = edges == EdgeEstimator::Cubic ? 8 : 2;
        shot.scene.effects.occlusion.reset();
        if (edges == EdgeEstimator::March) shot.scene.effects.occlusion.emplace();
        Renderer renderer = own_renderer();
        renderer.set_volume(shot.volume);
        const RenderResult first = picture(renderer, shot, settings);
        const std::uint64_t voxels = shot.volume->geometry.voxel_count();
        auto now = shot.volume;
        RenderResult before = first;
        for (const Change& change : {Change{"in the ring", {24, 10, 24}, 3.2, shot.volume->min_value},
                                     Change{"at a corner", {1, 46, 3}, 4.5, shot.volume->max_value},
                                     Change{"a voxel", {22, 4, 34}, 0.5, shot.volume->max_value}}) {
            SCOPED_TRACE(fmt::format("{}, edges {}", change.name, name_of(edges)));
            now = with_ball(*now, change.center, change.radius, change.value);
            const auto box = changed_box(*shot.volume, *now);
            ASSERT_TRUE(box);
            renderer.set_volume(now);
            const RenderResult changed = picture(renderer, shot, settings);
            Renderer fresh = own_renderer();
            fresh.set_volume(now);
            const RenderResult whole = picture(fresh, shot, settings);
            expect_same(changed, whole);
            EXPECT_GT(changed.stats.setup_milliseconds, 0);
            EXPECT_FALSE(changed.color.pixels == before.color.pixels) << "the change is invisible";
            before = changed;
            EXPECT_EQ(changed.stats.validation_messages, 0U);
            if (edges == EdgeEstimator::Cubic || edges == EdgeEstimator::Off) continue;
            EXPECT_EQ(whole.stats.voxels_estimated, voxels);
            EXPECT_GT(changed.stats.voxels_estimated, 0U);
            EXPECT_LT(changed.stats.voxels_estimated, voxels / 3);
        }
    }
}

TEST(ChangedRegion, AppliesSeveralChangesBeforeAPicture) {
    const Shot shot = torus_of(48);
    Renderer renderer = own_renderer();
    renderer.set_volume(shot.volume);
    picture(renderer, shot, {});
    const auto once = with_ball(*shot.volume, {24, 10, 24}, 3, shot.volume->min_value);
    const auto twice = with_ball(*once, {40, 40, 40}, 3, shot.volume->max_value);
    renderer.set_volume(once);
    renderer.set_volume(twice);
    Renderer fresh = own_renderer();
    fresh.set_volume(twice);
    expect_same(picture(renderer, shot, {}), picture(fresh, shot, {}));
    // With another scene at the same time, the change counts, too.
    Shot other = shot;
    other.scene.iso_values = {0.25, 0.6};
    renderer.set_volume(shot.volume);
    fresh.set_volume(shot.volume);
    expect_same(picture(renderer, other, {}), picture(fresh, other, {}));
    // Also with rays.
    renderer.raycast(shot.scene, shot.camera, {}, {.filter = RaycastFilter::Cubic}, 64, 48);
    renderer.set_volume(once);
    Renderer rays = own_renderer();
    rays.set_volume(once);
    for (const RaycastFilter filter : {RaycastFilter::Cubic, RaycastFilter::Trilinear})
        EXPECT_TRUE(renderer.raycast(shot.scene, shot.camera, {}, {.filter = filter}, 64, 48).color.pixels ==
                    rays.raycast(shot.scene, shot.camera, {}, {.filter = filter}, 64, 48).color.pixels);
    expect_same(picture(renderer, shot, {}), picture(rays, shot, {}));
}

TEST(ChangedRegion, EstimatesNothingForTheSameSamples) {
    const Shot shot = torus_of(32);
    Renderer renderer = own_renderer();
    renderer.set_volume(shot.volume);
    const RenderResult first = picture(renderer, shot, {});
    EXPECT_EQ(first.stats.voxels_estimated, shot.volume->geometry.voxel_count());
    renderer.set_volume(std::make_shared<Volume>(*shot.volume));
    const RenderResult again = picture(renderer, shot, {});
    EXPECT_EQ(again.stats.setup_milliseconds, 0);
    EXPECT_EQ(again.stats.voxels_estimated, 0U);
    expect_same(first, again);
}

/// Rays that find faces need the field even if all splats are already collected.
TEST(ChangedRegion, KeepsTracedFacesForTheSameSamples) {
    Shot shot = torus_of(32);
    shot.volume = std::make_shared<const Volume>(builtin_volume("builtin:gyroid:32"));
    shot.scene.iso_values = builtin_scene("builtin:gyroid:32").iso_values;
    shot.scene.materials = {{}, {{1, 0.85, 0.7}, 8}};
    Renderer renderer = own_renderer();
    renderer.set_volume(shot.volume);
    const RenderResult first = picture(renderer, shot, {});
    ASSERT_TRUE(std::ranges::any_of(first.stats.passes, [](const PassTime& p) { return p.name == "5_trace_faces"; }));
    renderer.set_volume(std::make_shared<Volume>(*shot.volume));
    const RenderResult again = picture(renderer, shot, {});
    EXPECT_EQ(again.stats.setup_milliseconds, 0);
    expect_same(first, again);
}

TEST(ChangedRegion, TreatsAnotherRangeOrGridAsANewVolume) {
    const Shot shot = torus_of(24);
    auto brighter = with_ball(*shot.volume, {12, 12, 12}, 1, shot.volume->max_value + 1);
    EXPECT_FALSE(changed_box(*shot.volume, *brighter));
    auto wider = std::make_shared<Volume>(*shot.volume);
    wider->geometry.origin.x += 1;
    EXPECT_FALSE(changed_box(*shot.volume, *wider));
    const auto box = changed_box(*shot.volume, *with_ball(*shot.volume, {5, 6, 7}, 1.1, shot.volume->max_value));
    ASSERT_TRUE(box);
    EXPECT_EQ(box->low, glm::ivec3(4, 5, 6));
    EXPECT_EQ(box->size(), glm::ivec3(3));
    Renderer renderer = own_renderer(), fresh = own_renderer();
    renderer.set_volume(shot.volume);
    picture(renderer, shot, {});
    renderer.set_volume(brighter);
    fresh.set_volume(brighter);
    expect_same(picture(renderer, shot, {}), picture(fresh, shot, {}));
}

}  // namespace
}  // namespace edgesplat::test

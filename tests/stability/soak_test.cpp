// The checks of `soak` over 10^4 frames, here with fewer frames.
#include "tests/stability/soak.h"

#include <gmock/gmock.h>

#include "engine/renderer.h"
#include "engine/scene/scene_document.h"
#include "engine/volume/analytic_volumes.h"

namespace edgesplat::test {
namespace {

TEST(Soak, ManyPicturesAreFiniteWithoutLeaks) {
    const SoakResult result = soak({.frames = 200, .seed = 5, .every = 50, .looks = 4, .validation = true});
    EXPECT_THAT(result.problems, testing::IsEmpty());
    ASSERT_EQ(result.samples.size(), 4U);
    for (const SoakSample& sample : result.samples) {
        EXPECT_EQ(sample.descriptors, result.samples.front().descriptors) << "frame " << sample.frame;
        EXPECT_EQ(sample.device_bytes, result.samples.front().device_bytes) << "frame " << sample.frame;
    }
}

TEST(Soak, ChangingVolumesDoNotLeak) {
#ifdef __SANITIZE_ADDRESS__
    GTEST_SKIP() << "the address sanitizer keeps freed memory";
#endif
    const auto sampled = [](const char* name, int side) {
        return std::make_shared<const Volume>(sample(resized(analytic_scene(name), glm::ivec3(side))));
    };
    const std::shared_ptr<const Volume> volumes[2] = {sampled("torus", 16), sampled("sphere", 20)};
    Renderer renderer;
    constexpr int kWarm = 30, kFrames = 110;
    double warm = 0;
    for (int frame = 0; frame < kFrames; ++frame) {
        if (frame == kWarm) warm = resident_mib();
        const auto& volume = volumes[frame % 2];
        renderer.set_volume(volume);
        const Camera camera{.eye = volume->geometry.center() - glm::dvec3(0, 40, 0)};
        renderer.render(resolve_scene({.iso_values = {0.5}}, *volume), camera, {}, 32, 32);
    }
    // A shader recompiled in each frame would take 15 MiB.
    EXPECT_LT(resident_mib() - warm, 2);
}

TEST(Soak, TemporaryRenderersDoNotLeak) {
#ifdef __SANITIZE_ADDRESS__
    GTEST_SKIP() << "the address sanitizer keeps freed memory";
#endif
    const auto volume = std::make_shared<const Volume>(sample(resized(analytic_scene("sphere"), glm::ivec3(16))));
    const Camera camera{.eye = volume->geometry.center() - glm::dvec3(0, 40, 0)};
    leave_no_holes();
    // Keeps the driver loaded, as in an application.
    const Renderer stays;
    constexpr int kWarm = 8, kRenderers = 36;
    double warm = 0;
    for (int i = 0; i < kRenderers; ++i) {
        if (i == kWarm) warm = resident_mib();
        Renderer renderer;
        renderer.set_volume(volume);
        Settings settings;
        settings.footprints = FootprintMode::Warp2d;
        settings.warp = WarpFamily::Paper;
        renderer.render(resolve_scene({.iso_values = {0.5}}, *volume), camera, settings, 32, 32);
    }
    // A shader recompiled in each renderer would take 1.8 MiB.
    EXPECT_LT(resident_mib() - warm, 0.9);
}

TEST(Soak, GrowthIsTheSlopeOfTheFittedLine) {
    std::vector<SoakSample> samples;
    for (int frame = 100; frame <= 2000; frame += 100)
        samples.push_back({.frame = frame, .host_mib = frame < 1000 ? 7.0 : 100 + 0.01 * (frame - 1500)});
    EXPECT_NEAR(host_growth(samples, 1000), 0.1, 1e-9);
    EXPECT_EQ(host_growth({}, 1000), 0);
}

}  // namespace
}  // namespace edgesplat::test

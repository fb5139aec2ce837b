// --max-error keeps its bound on volumes it was not tuned with: the large picture against its own reference.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>

#include "engine/accuracy/choose_settings.h"
#include "engine/accuracy/configurations.h"
#include "engine/accuracy/downsample.h"
#include "engine/accuracy/metrics.h"
#include "engine/reference/direct_evaluation.h"
#include "engine/scene/views.h"
#include "engine/volume/load_volume.h"
#include "tests/properties/test_renderer.h"

namespace edgesplat::test {
namespace {

struct Case {
    const char* name;
    const char* file;
    double iso;
    const char* view;
    double limit;
    int factor;  ///< downsampling factor, which keeps the test short
};

class MaxError : public testing::TestWithParam<Case> {};

TEST_P(MaxError, HoldsForTheLargePicture) {
    const Case& c = GetParam();
    const char* folder = std::getenv("EDGESPLAT_DATA");
    if (folder == nullptr || *folder == '\0') GTEST_SKIP() << "EDGESPLAT_DATA is not set: no folder of real volumes";
    Volume loaded = load_volume(std::string(folder) + "/" + c.file);
    if (c.factor > 1) loaded = accuracy::box_downsampled(loaded, c.factor);
    const auto volume = std::make_shared<const Volume>(std::move(loaded));
    Scene scene;
    scene.iso_values = {c.iso};
    scene.materials = {{}, {{1, 0.85, 0.75}, 8 / volume->geometry.spacing().x}};
    constexpr int kSize = 128;
    const Camera camera = named_view(c.view, {volume.get(), &scene, 45, kSize, kSize});

    Renderer& renderer = test_renderer();
    renderer.set_volume(volume);
    const accuracy::ChosenSettings choice =
        accuracy::choose_settings(renderer, *volume, scene, camera, kSize, kSize, {c.limit, {}});
    EXPECT_LE(choice.expected_error, c.limit);

    const reference::PreparedVolume model(*volume, scene, accuracy::model_of({}));
    const auto expected =
        reference::direct_evaluation(model, camera, kSize, kSize, reference::Output::Color, {5e-4, {}});
    // All configurations that could have been chosen, whichever was the fastest.
    std::size_t allowed = 0;
    for (const accuracy::TriedSettings& tried : choice.tried) {
        const double bound = accuracy::kErrorMargin * tried.error;
        if (bound > c.limit) continue;
        const RenderResult picture = renderer.render(scene, camera, tried.settings, kSize, kSize);
        const double error = accuracy::image_error(picture.color, expected.image).rms;
        std::printf("%s: limit %.4f, expected %.5f, measured small %.5f, large %.5f with %s\n", c.name, c.limit, bound,
                    tried.error, error, accuracy::settings_key(tried.settings).c_str());
        EXPECT_LE(error, bound);
        ++allowed;
    }
    EXPECT_GT(allowed, 0U);
}

INSTANTIATE_TEST_SUITE_P(RealVolumes, MaxError,
                         testing::Values(Case{"hydrogen", "hydrogen/hydrogenatom.nhdr", 8, "oblique", 0.01, 3},
                                         Case{"nucleon", "nucleon/nucleon.nrrd", 140, "oblique", 0.005, 1},
                                         Case{"walnut", "walnut_ct/walnut.nhdr", 8000, "oblique", 0.01, 4},
                                         Case{"headsq", "headsq_ct/headsq.nhdr", 1150, "front", 0.008, 2}),
                         [](const testing::TestParamInfo<Case>& parameter) {
                             return std::string(parameter.param.name);
                         });

}  // namespace
}  // namespace edgesplat::test

// Looks by name, surfaces by standard deviations, and recognition of segmentations.
#include <gmock/gmock.h>

#include <functional>

#include "engine/error.h"
#include "engine/scene/default_materials.h"
#include "engine/scene/scene_document.h"
#include "engine/scene/scene_presets.h"
#include "engine/scene/transfer_function.h"
#include "engine/volume/analytic_volumes.h"
#include "engine/volume/labels.h"

namespace edgesplat {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// Nested boxes of the labels 0, 2, 5 and 9.
Volume segmentation() {
    Volume volume;
    volume.geometry.dims = glm::ivec3(24);
    volume.name = "segmentation";
    for (int z = 0; z < 24; ++z)
        for (int y = 0; y < 24; ++y)
            for (int x = 0; x < 24; ++x) {
                const int in = std::min({x, y, z, 23 - x, 23 - y, 23 - z});
                volume.values.push_back(in < 3 ? 0.0F : x < 8 ? 2.0F : x < 16 ? 5.0F : 9.0F);
            }
    finish_volume(volume);
    return volume;
}

TEST(SceneLooks, EveryKindOfDataHasLook) {
    for (const char* name :
         {"ct-skin-bone", "ct-skull", "mri-head", "angiography", "micro-ct", "segmentation", "electron-density"}) {
        EXPECT_EQ(scene_preset(name).kind, PresetKind::Look) << name;
        SceneDocument d;
        d.volume.path = "builtin:phantom:16";
        apply_look(d, name);
        EXPECT_THAT(problems_of(d, {}), IsEmpty()) << name;
        EXPECT_FALSE(d.lights.empty()) << name;
        // A builtin volume would set its own surfaces.
        Volume head = builtin_volume("builtin:phantom:16");
        head.name = "head";
        // Looks for densities and labels do not fit a head.
        if (!d.volume.labels && d.iso_sigmas.empty()) {
            EXPECT_EQ(resolve_scene(d, head).lights, d.lights) << name;
        }
    }
}

TEST(SceneLooks, ReplacePreviousSettings) {
    SceneDocument d;
    d.iso_values = {5};
    d.materials.resize(1);
    d.transfer_preset = "ct-soft-tissue-and-bone";
    d.lights.clear();
    apply_look(d, "ct-skin-bone");
    EXPECT_THAT(d.iso_values, ElementsAre(-300, 280));
    EXPECT_TRUE(d.transfer_preset.empty());
    EXPECT_EQ(d.lights.size(), 2U);
    const Scene scene = resolve_scene(d, builtin_volume("builtin:phantom:16"));
    EXPECT_EQ(scene.materials[1].extinction, 0.03) << "skin is translucent";
    EXPECT_EQ(scene.materials[2].extinction, 8) << "bone is opaque";
    // apply_look accepts presets of every kind.
    apply_look(d, "ct-bone");
    EXPECT_EQ(d.materials.size(), 1U);
    EXPECT_EQ(d.lights, std::vector<Light>{Light{}});
    EXPECT_THROW(apply_look(d, "ct-skin-bones"), Error);
}

TEST(SceneLooks, PlaceSurfacesByStandardDeviations) {
    Volume volume;
    volume.geometry.dims = {10, 10, 1};
    volume.name = "two values";
    for (int i = 0; i < 100; ++i)
        volume.values.push_back(i < 20 ? 14.0F : 4.0F);  // mean 6, standard deviation 4
    finish_volume(volume);
    SceneDocument d;
    d.iso_sigmas = {0, 1.5};
    const Scene scene = resolve_scene(d, volume);
    ASSERT_EQ(scene.iso_values.size(), 2U);
    EXPECT_NEAR(scene.iso_values[0], 6, 1e-9);
    EXPECT_NEAR(scene.iso_values[1], 12, 1e-9);
    d.iso_values = {7};
    EXPECT_EQ(problems_of(d, {}).back().path, "iso_sigmas");
}

TEST(SceneLooks, RecogniseSegmentations) {
    const Volume raw = segmentation();
    SceneDocument d;
    Volume volume = raw;
    recognise_labels(d, volume);
    EXPECT_EQ(d.volume.labels, true);
    const Scene scene = resolve_scene(d, volume);
    EXPECT_THAT(scene.iso_values, ElementsAre(0.5));
    for (const int label : {2, 5, 9}) {
        const TransferPoint drawn = transfer_at(scene.transfer, double{1 + float(label) / 1024});
        EXPECT_LT(glm::length(drawn.color - default_label_color(static_cast<std::size_t>(label))), 1e-3) << label;
        EXPECT_GT(drawn.extinction, 1) << label;
    }
    EXPECT_EQ(transfer_at(scene.transfer, 0).extinction, 0);
    // Loading with the source that the picture records gives the same volume.
    VolumeSource source;
    source.labels = true;
    EXPECT_EQ(preprocessed(raw, source).checksum, volume.checksum);
}

TEST(SceneLooks, ExplicitSettingsDisableRecognition) {
    const auto left = [](const std::function<void(SceneDocument&)>& said) {
        SceneDocument d;
        said(d);
        Volume volume = segmentation();
        const std::uint64_t before = volume.checksum;
        recognise_labels(d, volume);
        return volume.checksum == before;
    };
    EXPECT_FALSE(left([](SceneDocument&) {}));
    EXPECT_TRUE(left([](SceneDocument& d) { d.iso_values = {1.5}; }));
    EXPECT_TRUE(left([](SceneDocument& d) { d.volume.labels = false; }));
    EXPECT_TRUE(left([](SceneDocument& d) { d.volume.threshold = 3; }));
    EXPECT_TRUE(left([](SceneDocument& d) { d.output.compare_raycast = true; }));
    EXPECT_TRUE(left([](SceneDocument& d) { apply_look(d, "ct-bone"); }));
}

TEST(SceneLooks, NeighbouringLabelsHaveDistinctColours) {
    for (std::size_t label = 1; label < 60; ++label)
        for (std::size_t other = label + 1; other < label + 5; ++other)
            EXPECT_GT(glm::length(default_label_color(label) - default_label_color(other)), 0.1)
                << label << ' ' << other;
}

}  // namespace
}  // namespace edgesplat

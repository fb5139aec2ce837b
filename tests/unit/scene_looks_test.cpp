// Looks by name, surfaces by standard deviations, and recognition of segmentations.
#include <gmock/gmock.h>

#include <algorithm>
#include <functional>

#include "engine/error.h"
#include "engine/scene/default_materials.h"
#include "engine/scene/scene_document.h"
#include "engine/scene/scene_presets.h"
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
    const Volume volume = prepared_volume(d, raw);
    EXPECT_EQ(d.volume.labels, true);
    const Scene scene = resolve_scene(d, volume);
    EXPECT_THAT(scene.iso_values, ElementsAre(0.5));
    ASSERT_EQ(scene.label_colors.size(), 4U);
    for (const std::size_t place : {1, 2, 3})
        EXPECT_EQ(scene.label_colors[place],
                  default_label_color(static_cast<std::size_t>(volume.labels->labels[place].value)));
    EXPECT_GT(scene.materials.back().extinction, 1);
    EXPECT_EQ(scene.materials.front().extinction, 0);
    // Loading with the source that the picture records gives the same volume.
    VolumeSource source;
    source.labels = true;
    EXPECT_EQ(preprocessed(raw, source).checksum, volume.checksum);
    // So does the scene with everything written out.
    SceneDocument all = resolved(d, volume, scene, {}, {});
    EXPECT_THAT(all.iso_values, IsEmpty());
    const Volume again = prepared_volume(all, raw);
    EXPECT_EQ(again.checksum, volume.checksum);
    EXPECT_EQ(resolve_scene(all, again).label_colors, scene.label_colors);
    EXPECT_EQ(resolve_scene(all, again).materials, scene.materials);
}

TEST(SceneLooks, AcceptChecksumsOfSamplesAndOfLabels) {
    const Volume raw = segmentation();
    SceneDocument d;
    const Volume drawn = prepared_volume(d, raw);
    for (const std::uint64_t checksum : {raw.checksum, drawn.checksum}) {
        SceneDocument open;
        open.volume.checksum = fmt::format("{:016x}", checksum);
        EXPECT_EQ(prepared_volume(open, raw).checksum, drawn.checksum);
    }
    SceneDocument other;
    other.volume.checksum = "0123456789abcdef";
    EXPECT_THROW(prepared_volume(other, raw), Error);
}

/// The samples 0 or 1 of the drawn labels, or the file's numbers.
Volume prepared(const std::function<void(SceneDocument&)>& said) {
    SceneDocument d;
    said(d);
    return prepared_volume(d, segmentation());
}

TEST(SceneLooks, NumbersInSceneDisableLabels) {
    EXPECT_TRUE(prepared([](SceneDocument&) {}).shown_labels);
    EXPECT_TRUE(prepared([](SceneDocument& d) { d.output.compare_raycast = true; }).shown_labels);
    EXPECT_TRUE(prepared([](SceneDocument& d) { d.materials = {{.extinction = 3}}; }).shown_labels);
    EXPECT_FALSE(prepared([](SceneDocument& d) { d.iso_values = {1.5}; }).shown_labels);
    EXPECT_FALSE(prepared([](SceneDocument& d) { d.volume.labels = false; }).shown_labels);
    EXPECT_FALSE(prepared([](SceneDocument& d) { d.volume.threshold = 3; }).shown_labels);
    EXPECT_FALSE(prepared([](SceneDocument& d) { apply_look(d, "ct-bone"); }).shown_labels);
    // Iso-values of labels are about the file's numbers.
    const auto iso = [](SceneDocument& d) {
        d.volume.labels = true;
        d.iso_values = {7.5};
    };
    EXPECT_EQ(prepared(iso).max_value, 9);
}

TEST(SceneLooks, ChooseLabelsByNumberAndName) {
    const Volume raw = [] {
        Volume volume = segmentation();
        auto table = *labels_of(volume);
        table.labels[1].name = "Left Lung";
        table.labels[2].name = "right lung";
        table.labels[3].name = "heart, with vessels";
        volume.labels = std::make_shared<const LabelTable>(table);
        return volume;
    }();
    const auto shown = [&](std::vector<std::string> only, std::vector<std::string> hide) {
        SceneDocument d;
        d.volume.only = std::move(only);
        d.volume.hide = std::move(hide);
        const Volume volume = prepared_volume(d, raw);
        std::vector<float> values;
        for (const std::uint32_t number : volume.shown_labels->largest)
            values.push_back(volume.labels->labels[number - 1].value);
        std::ranges::sort(values);
        return values;
    };
    EXPECT_THAT(shown({"5"}, {}), ElementsAre(5));
    EXPECT_THAT(shown({"left LUNG"}, {}), ElementsAre(2));
    EXPECT_THAT(shown({"*lung"}, {}), ElementsAre(2, 5));
    EXPECT_THAT(shown({"heart, with vessels"}, {}), ElementsAre(9));
    EXPECT_THAT(shown({"2,right lung"}, {}), ElementsAre(2, 5));
}

TEST(SceneLooks, RefuseUnknownLabels) {
    const auto refusal = [](const std::function<void(SceneDocument&)>& said) -> std::string {
        try {
            prepared(said);
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_THAT(
        refusal([](SceneDocument& d) { d.volume.only = {"3"}; }),
        testing::HasSubstr("volume.only (--only): segmentation has no label '3'; its 4 labels have numbers, from "
                           "0 to 9, and no names"));
    EXPECT_THAT(refusal([](SceneDocument& d) { d.volume.hide = {"2,5,9"}; }), testing::HasSubstr("is left"));
    EXPECT_THAT(refusal([](SceneDocument& d) {
                    d.volume.only = {"2"};
                    d.iso_values = {3};
                }),
                testing::HasSubstr("chooses labels, but iso_values (--iso)"));
}

TEST(SceneLooks, NeighbouringLabelsHaveDistinctColours) {
    for (std::size_t label = 1; label < 60; ++label)
        for (std::size_t other = label + 1; other < label + 5; ++other)
            EXPECT_GT(glm::length(default_label_color(label) - default_label_color(other)), 0.1)
                << label << ' ' << other;
}

}  // namespace
}  // namespace edgesplat

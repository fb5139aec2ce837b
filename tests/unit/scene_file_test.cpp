// Scene files: documents round-trip, every key of the table works, and every problem names its line.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <random>

#include "engine/scene/scene_file.h"
#include "engine/scene/scene_keys.h"
#include "engine/scene/scene_presets.h"
#include "engine/volume/analytic_volumes.h"
#include "tests/unit/refusal.h"
#include "tests/unit/scene_texts.h"

namespace edgesplat {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

/// A random value of the key's type and range.
KeyValue random_value(const SceneKey& key, std::mt19937& random) {
    std::uniform_real_distribution<double> share(0.001, 0.999);
    const auto number = [&] {
        const double low = std::isfinite(key.range.low) ? key.range.low : -1000;
        const double high = std::isfinite(key.range.high) ? key.range.high : low + 5000;
        const double value = low + (high - low) * share(random);
        const bool whole = key.type == KeyType::Integer || key.type == KeyType::Integers;
        return whole ? std::ceil(value) : value;
    };
    const auto text = [&]() -> std::string {
        if (!key.choices.empty()) return key.choices[random() % key.choices.size()];
        return "a \"text\" \\ with\nlines \t\x01 and \xC3\xA4 " + std::to_string(random());
    };
    const auto list = [&](std::size_t count) {
        std::vector<double> values;
        for (std::size_t i = 0; i < count; ++i)
            values.push_back(number());
        return values;
    };
    switch (key.type) {
        case KeyType::Flag:
            return random() % 2 == 0;
        case KeyType::Number:
        case KeyType::Integer:
            return number();
        case KeyType::Text:
            return text();
        case KeyType::Texts:
            return std::vector<std::string>{text(), text()};
        default:
            return list(key.count > 0 ? key.count : 6);
    }
}

/// A document with a random value for every key of the table. It need not be consistent.
SceneDocument random_document(std::mt19937& random) {
    SceneDocument document;
    for (const SceneTable& table : scene_tables())
        table.resize(document, table.list ? 1 + random() % 2 : 1);
    for (const SceneKey& key : scene_keys()) {
        const std::string table = table_of(key);
        const SceneTable* group = find_table(table.ends_with("[]") ? table.substr(0, table.size() - 2) : table);
        for (std::size_t i = 0; i < (group ? group->count(document) : 1); ++i)
            key.set(document, i, random_value(key, random));
    }
    return document;
}

TEST(SceneFile, EveryKeyRoundTripsThroughText) {
    std::mt19937 random(1);
    for (int round = 0; round < 50; ++round) {
        const SceneDocument document = random_document(random);
        const std::string text = scene_text(document);
        EXPECT_TRUE(parse_scene(text, "a.toml", {.whole = false}) == document) << text;
    }
}

TEST(SceneFile, EveryKeyRoundTripsThroughSet) {
    std::mt19937 random(2);
    SceneDocument document;
    for (const SceneTable& table : scene_tables())
        table.resize(document, 1);
    for (const SceneKey& key : scene_keys()) {
        const KeyValue value = random_value(key, random);
        if (key.points) continue;
        set_key(document, key.path_at(0) + "=" + toml_text(value, key.type));
        ASSERT_TRUE(key.get(document, 0).has_value()) << key.path;
        EXPECT_TRUE(*key.get(document, 0) == value) << key.path;
    }
    set_key(document, "movie.flight.points=[[1, 2, 3], [4, 5, 6.5]]");
    EXPECT_THAT(document.movie.flight->points, ElementsAre(1, 2, 3, 4, 5, 6.5));
}

TEST(SceneFile, NumbersKeepTheirBits) {
    std::mt19937_64 random(3);
    const auto limits = std::numeric_limits<double>();
    std::vector<double> values{limits.denorm_min(), limits.min(), limits.max(), -limits.max(), 0.1, 1e22, -0.0, 1};
    while (values.size() < 2000) {
        const double value = std::bit_cast<double>(random());
        if (std::isfinite(value)) values.push_back(value);
    }
    for (const double value : values) {
        SceneDocument document;
        document.volume.path = "builtin:sphere";
        document.camera.eye = glm::dvec3(value, 1, 2);
        EXPECT_EQ(std::bit_cast<std::uint64_t>(parse(scene_text(document)).camera.eye->x),
                  std::bit_cast<std::uint64_t>(value))
            << value;
    }
}

TEST(SceneFile, EveryGoodSceneRoundTripsThroughText) {
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(EDGESPLAT_SOURCE_DIR "/tests/scenes/good")) {
        const SceneDocument document = read_scene_file(entry.path());
        EXPECT_TRUE(parse(scene_text(document)) == document) << entry.path();
        EXPECT_TRUE(parse(commented_scene_text(document)) == document) << entry.path();
        const Volume volume = load_source(document.volume, {});
        const Scene scene = resolve_scene(document, volume);
        const Camera camera = resolve_camera(document, volume, scene);
        SceneDocument all = resolved(document, volume, scene, camera, document.quality.settings);
        EXPECT_TRUE(parse(scene_text(all)) == all) << entry.path();
        // Resolving a resolved document changes nothing.
        const Scene again = resolve_scene(all, volume);
        EXPECT_EQ(again.iso_values, scene.iso_values);
        EXPECT_EQ(again.materials, scene.materials);
        EXPECT_EQ(again.transfer, scene.transfer);
        EXPECT_EQ(again.lights, scene.lights);
        EXPECT_EQ(again.effects, scene.effects);
        const Camera same = resolve_camera(all, volume, again);
        EXPECT_EQ(same.eye, camera.eye);
        EXPECT_EQ(same.direction, camera.direction);
        EXPECT_EQ(same.up, camera.up);
        EXPECT_EQ(same.fov_y, camera.fov_y);
        ++count;
    }
    EXPECT_GE(count, 7U);
}

TEST(SceneFile, RangesMatchEngineValidation) {
    // validate() accepts a number at the ends of its range and refuses it beyond them.
    SceneDocument document;
    for (const SceneTable& table : scene_tables())
        table.resize(document, 1);
    document.volume.path = "builtin:sphere:16";
    document.iso_values = {0.5};
    document.transfer[0].value = 0.1;
    document.camera = {};
    const Volume volume = builtin_volume("builtin:sphere:16");
    const auto takes = [&](const SceneDocument& d) {
        try {
            resolve_scene(d, volume);
            validate(d.quality.settings);
            return true;
        } catch (const Error&) {
            return false;
        }
    };
    ASSERT_TRUE(takes(document));
    std::size_t count = 0;
    for (const SceneKey& key : scene_keys()) {
        const std::string top = key.path.substr(0, key.path.find_first_of(".["));
        if (top == "volume" || top == "movie" || top == "output" || top == "camera" || key.path == "iso_values" ||
            key.path == "iso_sigmas")
            continue;
        // Skipped keys: not part of a scene, checked by their order, or used by one kind of light only.
        if (key.path == "quality.max_error" || key.path == "transfer[].value" || key.direction ||
            key.path == "lights[].position")
            continue;
        const bool whole = key.type == KeyType::Integer;
        if (key.type != KeyType::Number && !whole && key.type != KeyType::Numbers) continue;
        const auto with = [&](double number) {
            SceneDocument changed = document;
            const KeyValue value = key.count > 0 ? KeyValue(std::vector<double>(key.count, number)) : KeyValue(number);
            EXPECT_EQ(key.refusal(value).empty(),
                      [&] {
                          try {
                              key.set(changed, 0, value);
                          } catch (const Error&) {
                              return false;
                          }
                          return takes(changed);
                      }())
                << key.path << " = " << number;
        };
        for (const double end : {key.range.low, key.range.high}) {
            if (!std::isfinite(end)) continue;
            const double step = whole ? 1 : 1e-9 * std::max(std::abs(end), 1.0);
            with(end - step);
            with(end);
            with(end + step);
        }
        with(std::numeric_limits<double>::infinity());
        if (!whole) with(std::numeric_limits<double>::quiet_NaN());
        ++count;
    }
    EXPECT_GT(count, 30U);
}

TEST(SceneFile, ReportsEveryProblemWithItsLine) {
    EXPECT_THAT(problems("fram = 1\n"
                         "[volume]\n"
                         "path = \"builtin:sphere\"\n"
                         "[effects.fog]\n"
                         "density = -1\n"
                         "start = \"near\"\n"
                         "[output]\n"
                         "size = [0, 2]\n"),
                ElementsAre(StartsWith("a.toml:1: fram: unknown key"), StartsWith("a.toml:5: effects.fog.density: -1"),
                            StartsWith("a.toml:6: effects.fog.start: 'near': expected"),
                            StartsWith("a.toml:8: output.size: [0, 2]: expected")));
}

TEST(SceneFile, SettingsOverridePresetInAnyOrder) {
    const SceneDocument d =
        parse("[volume]\npath = \"builtin:sphere\"\n[quality]\nedges = \"off\"\npreset = \"accurate\"\n");
    EXPECT_EQ(d.quality.settings.edges, EdgeEstimator::Off);
    EXPECT_EQ(d.quality.settings.sheet_spacing, 0.5);
    EXPECT_EQ(d.quality.preset, "accurate");
}

TEST(SceneFile, SetAcceptsTypedValues) {
    SceneDocument d;
    set_key(d, "camera.view=back");
    set_key(d, "background=0,0.5,1");
    set_key(d, "output.aovs=tau,depth");
    set_key(d, "effects.silhouette=true");
    set_key(d, "effects.fog.density=0.25");
    set_key(d, "lights[1].kind=point");
    set_key(d, "lights[1].position[2]=7");
    set_key(d, "iso_values=-400,300");
    set_key(d, "iso_values[1]=250");
    EXPECT_EQ(d.camera.view, "back");
    EXPECT_EQ(d.background, glm::dvec3(0, 0.5, 1));
    EXPECT_THAT(d.output.aovs, ElementsAre("tau", "depth"));
    EXPECT_TRUE(d.effects.silhouette.has_value());
    EXPECT_EQ(d.effects.fog->density, 0.25);
    ASSERT_EQ(d.lights.size(), 2U);
    EXPECT_EQ(d.lights[1].kind, Light::Kind::Point);
    EXPECT_EQ(d.lights[1].position, glm::dvec3(0, 0, 7));
    EXPECT_THAT(d.iso_values, ElementsAre(-400, 250));
    set_key(d, "effects.fog=false");
    EXPECT_FALSE(d.effects.fog.has_value());
    set_key(d, "lights=[]");
    EXPECT_TRUE(d.lights.empty());

    const SceneDocument before = d;
    EXPECT_THAT(refusal([&] { set_key(d, "effects.fog.densty=1"); }), HasSubstr("did you mean effects.fog.density?"));
    EXPECT_THAT(refusal([&] { set_key(d, "effects.fog.density=-1"); }), HasSubstr("-1"));
    EXPECT_THAT(refusal([&] { set_key(d, "effects.fog.density=thick"); }), HasSubstr("expected a number"));
    EXPECT_THAT(refusal([&] { set_key(d, "lights[2].kind=point"); }), HasSubstr("lights[2].kind"));
    EXPECT_THAT(refusal([&] { set_key(d, "camera.view"); }), HasSubstr("KEY=VALUE"));
    EXPECT_THAT(refusal([&] { set_key(d, "lights[x].kind=point"); }), HasSubstr("whole number"));
    EXPECT_THAT(refusal([&] { set_key(d, "background[3]=1"); }), HasSubstr("3 numbers"));
    EXPECT_THAT(refusal([&] { set_key(d, "background[0]=2"); }), HasSubstr("from 0 to 1"));
    EXPECT_TRUE(d == before) << "a refused value changes nothing";
}

TEST(SceneFile, SetsAndReadsNumbersByKey) {
    SceneDocument d;
    d.effects.fog.emplace();
    d.effects.clip.keep.resize(1);
    d.iso_values = {1, 2};
    for (const char* key : {"effects.fog.density", "effects.clip.keep[0].point[1]", "iso_values[0]", "camera.fov",
                            "ambient", "lights[0].intensity", "effects.samples", "quality.sheet_spacing"}) {
        set_number(d, key, 2);
        EXPECT_EQ(number_at(d, key), 2) << key;
    }
    EXPECT_EQ(d.effects.clip.keep[0].point, glm::dvec3(0, 2, 0));
    EXPECT_THAT(refusal([&] { set_number(d, "effects.silhouette.strength", 1); }), HasSubstr("no effects.silhouette"));
    EXPECT_THAT(refusal([&] { set_number(d, "effects.clip.keep[1].point[0]", 1); }), HasSubstr("effects.clip.keep"));
    EXPECT_THAT(refusal([&] { set_number(d, "camera.view", 1); }), HasSubstr("camera.view"));
    EXPECT_THAT(refusal([&] { set_number(d, "effects.samples", 1.5); }), HasSubstr("whole number"));
}

TEST(ScenePresets, EmbeddedPresetsAreValid) {
    const auto names = scene_preset_names();
    for (const char* name : {"ct-skin", "ct-bone", "ct-airway", "ct-lung", "ct-vessels", "ct-soft-tissue",
                             "mri-gray-matter", "mri-white-matter", "mri-skin"})
        EXPECT_THAT(names, Contains(name));
    for (const std::string& name : names) {
        const ScenePreset preset = scene_preset(name);
        EXPECT_FALSE(preset.content.about.empty()) << name;
        if (preset.kind == PresetKind::Look) continue;
        EXPECT_EQ(preset.content.iso_values.empty(), name.starts_with("mri-") && !preset.is_transfer()) << name;
        for (const MaterialChoice& material : preset.content.materials) {
            EXPECT_FALSE(material.name.empty()) << name;
            EXPECT_TRUE(material.color && material.extinction) << name;
        }
    }
}

TEST(ScenePresets, UserPresetsOverrideEmbeddedOnes) {
    const std::filesystem::path folder = std::filesystem::temp_directory_path() / "edgesplat_presets_test";
    std::filesystem::create_directories(folder / "edgesplat" / "presets");
    const auto write = [](const std::filesystem::path& path, const char* text) { std::ofstream(path) << text; };
    write(folder / "ct-bone.toml", "[[materials]]\nname = \"mine\"\nextinction = 3\n");
    write(folder / "edgesplat" / "presets" / "ct-bone.toml", "[[materials]]\nname = \"later\"\n");
    write(folder / "edgesplat" / "presets" / "other.toml", "[[materials]]\nname = \"other\"\n");
    write(folder / "cycle.toml", "[[materials]]\npreset = \"cycle\"\n");
    write(folder / "both.toml", "[[materials]]\n[[transfer]]\n");
    write(folder / "scene.toml", "[volume]\npath = \"builtin:sphere\"\n");
    setenv("EDGESPLAT_PRESETS", folder.c_str(), 1);
    setenv("XDG_CONFIG_HOME", folder.c_str(), 1);
    EXPECT_EQ(scene_preset("ct-bone").content.materials[0].name, "mine");
    EXPECT_EQ(scene_preset("ct-bone").file, (folder / "ct-bone.toml").string());
    EXPECT_EQ(scene_preset("other").content.materials[0].name, "other");
    EXPECT_EQ(scene_preset("ct-skin").file, "built in");
    EXPECT_THAT(refusal([] { scene_preset("cycle"); }), HasSubstr("cannot use another preset"));
    EXPECT_THAT(refusal([] { scene_preset("both"); }), HasSubstr("expected one [[materials]]"));
    EXPECT_THAT(refusal([] { scene_preset("scene"); }), AllOf(HasSubstr("scene.toml:2"), HasSubstr("not for presets")));
    EXPECT_THAT(refusal([] { scene_preset("../ct-bone"); }), HasSubstr("no preset has this name"));
    unsetenv("EDGESPLAT_PRESETS");
    EXPECT_EQ(scene_preset("ct-bone").content.materials[0].name, "later");
    unsetenv("XDG_CONFIG_HOME");
    std::filesystem::remove_all(folder);
}

TEST(SceneDocuments, PresetsSetIsoValuesAndColours) {
    const Volume volume = builtin_volume("builtin:phantom:24");
    SceneDocument d;
    d.volume.path = "builtin:phantom:24";
    d.materials.resize(2);
    d.materials[0] = {.preset = "ct-bone", .extinction = 2.5};
    d.materials[1].preset = "ct-soft-tissue";
    const Scene scene = resolve_scene(d, volume);
    EXPECT_THAT(scene.iso_values, ElementsAre(-150, 300)) << "sorted, independent of the order in the file";
    EXPECT_EQ(scene.materials[1].name, "soft tissue");
    EXPECT_EQ(scene.materials[2].name, "bone");
    EXPECT_EQ(scene.materials[2].extinction, 2.5);
    EXPECT_EQ(scene.materials[2].color, glm::dvec3(0.90, 0.84, 0.72));
    EXPECT_EQ(scene.materials[0].extinction, 0);
}

TEST(SceneKeys, DocumentContainsKeyTable) {
    std::ifstream in(EDGESPLAT_SOURCE_DIR "/docs/scene_files.md");
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    const std::string begin = "<!-- keys: made by `edgesplat scene keys --markdown` -->\n",
                      end = "<!-- end of keys -->";
    const std::size_t from = text.find(begin) + begin.size(), to = text.find(end);
    ASSERT_NE(to, std::string::npos);
    EXPECT_EQ(text.substr(from, to - from), scene_keys_markdown())
        << "paste the output of `edgesplat scene keys --markdown`";
}

}  // namespace
}  // namespace edgesplat

// Reads, writes and resolves scenes with several volumes.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/scene/cuts.h"
#include "engine/scene/default_materials.h"
#include "engine/scene/label_fade.h"
#include "engine/scene/scene_file.h"
#include "engine/scene/scene_keys.h"
#include "engine/scene/views.h"
#include "engine/volume/analytic_volumes.h"
#include "engine/volume/chord.h"
#include "tests/unit/refusal.h"
#include "tests/unit/scene_texts.h"

namespace edgesplat {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* kText = R"(
iso_values = [0.5]
[volume]
path = "builtin:sphere:20"
[[volumes]]
iso_values = [0.4]
[volumes.volume]
path = "builtin:box:16"
transform = [0,-1,0,5, 1,0,0,6, 0,0,2,7, 0,0,0,1]
clip = false
[[volumes.materials]]
color = [1, 0, 0]
[[volumes]]
volume.path = "builtin:orbital:16"
volume.visible = false
)";

/// The document with its volumes read, and the first of them.
SceneDocument read(std::string_view text, Volume& first) {
    SceneDocument document = parse(std::string(text));
    first = load_scene_volume(document, {});
    return document;
}

TEST(SceneVolumes, AreWrittenAsTheyWereRead) {
    const SceneDocument document = parse(kText);
    ASSERT_EQ(document.volumes.size(), 2U);
    EXPECT_EQ(document.volumes[0].volume.path, "builtin:box:16");
    EXPECT_THAT(document.volumes[0].iso_values, ElementsAre(0.4));
    EXPECT_FALSE(document.volumes[0].volume.clip);
    EXPECT_FALSE(document.volumes[1].volume.visible);
    EXPECT_EQ(parse(scene_text(document)), document);
    EXPECT_EQ(parse(commented_scene_text(document)), document);
    EXPECT_EQ(parse(commented_scene_text(parse("volume.path = \"builtin:sphere\""))).volumes.size(), 0U);
}

TEST(SceneVolumes, HaveProblemsWithTheirLines) {
    EXPECT_THAT(
        problems("volume.path = \"builtin:sphere\"\n[[volumes]]\nvolume.path = \"builtin:box\"\n"
                 "camera.view = \"top\"\niso_values = \"a\"\n[volumes.volume.nested]\n"),
        AllOf(Contains(AllOf(HasSubstr("a.toml:4: volumes[0].camera"), HasSubstr("not for one volume of several"))),
              Contains(AllOf(HasSubstr("a.toml:5: volumes[0].iso_values"), HasSubstr("expected"))),
              Contains(HasSubstr("a.toml:6: volumes[0].volume.nested"))));
    EXPECT_THAT(problems("volume.path = \"builtin:sphere\"\n[[volumes]]\n\niso_values = [2, 1]\n"),
                ElementsAre(AllOf(HasSubstr("a.toml:2: volumes[0].volume.path"), HasSubstr("missing")),
                            AllOf(HasSubstr("a.toml:4: volumes[0].iso_values"), HasSubstr("ascending"))));
    EXPECT_THAT(problems("volume.path = \"builtin:sphere\"\nvolumes = 3\n"), Contains(HasSubstr("[[volumes]]")));
    std::string many = "volume.path = \"builtin:sphere\"\n";
    for (int i = 0; i < 16; ++i)
        many += "[[volumes]]\nvolume.path = \"builtin:box\"\n";
    EXPECT_THAT(problems(many), Contains(HasSubstr("expected at most 15")));
    EXPECT_THAT(problems("volume.path = \"builtin:sphere\"\noutput.renderer = \"truth\"\n"
                         "[[volumes]]\nvolume.path = \"builtin:box\"\n"),
                Contains(HasSubstr("draws one volume")));
    EXPECT_THAT(problems("volume.path = \"builtin:sphere\"\nvolume.rule = \"inside\"\n"),
                Contains(HasSubstr("a.toml:2: volume.rule")));
    EXPECT_THAT(problems("volume.path = \"builtin:sphere\"\n[[volumes]]\nvolume.path = \"builtin:box\"\n"
                         "volume.rule = \"inside\"\n"),
                testing::IsEmpty());
    EXPECT_THAT(problems("volume.path = \"builtin:sphere\"\nvolume.transform = [1, 2]\n"),
                Contains(HasSubstr("expected a list of 16 numbers")));
}

TEST(SceneVolumes, KeysAreSetByTheirAddress) {
    SceneDocument document = parse("volume.path = \"builtin:sphere\"");
    set_key(document, "volumes[0].volume.path=builtin:box");
    set_key(document, "volumes[0].iso_values=0.25");
    set_key(document, "volumes[0].materials[0].color=1,0,0");
    ASSERT_EQ(document.volumes.size(), 1U);
    EXPECT_THAT(document.volumes[0].iso_values, ElementsAre(0.25));
    EXPECT_EQ(document.volumes[0].materials[0].color, glm::dvec3(1, 0, 0));
    EXPECT_EQ(number_at(document, "volumes[0].iso_values[0]"), 0.25);
    animate_number(document, "volumes[0].iso_values[0]", 0.5);
    EXPECT_EQ(number_at(document, "volumes[0].iso_values[0]"), 0.5);
    animate_number(document, "volumes[0].volume.frame", 2.4);
    EXPECT_EQ(document.volumes[0].volume.frame, 2);
    set_key(document, "volumes=[{volume.path = \"builtin:torus\"}]");
    EXPECT_EQ(document.volumes[0].volume.path, "builtin:torus");
    const auto refused = [&](const char* assignment) {
        const SceneDocument before = document;
        const std::string text = refusal([&] { set_key(document, assignment); });
        EXPECT_EQ(document, before);
        return text;
    };
    EXPECT_THAT(refused("volumes[2].iso_values=1"), HasSubstr("expected an index from 0 to 1"));
    EXPECT_THAT(refused("volumes[0].camera.view=top"), HasSubstr("expected volumes[NUMBER].KEY"));
    EXPECT_THAT(refused("volumes[0].volume.pth=a"),
                AllOf(HasSubstr("volumes[0].volume.pth"), HasSubstr("unknown key")));
    EXPECT_THAT(refused("volumes[x].iso_values=1"), HasSubstr("expected volumes[NUMBER].KEY"));
    EXPECT_THAT(refusal([&] { number_at(document, "volumes[4].iso_values[0]"); }), HasSubstr("volumes[4]"));
}

TEST(SceneVolumes, LieWhereTheirMatricesPutThem) {
    Volume first;
    const SceneDocument document = read(kText, first);
    const Volume cube = builtin_volume("builtin:box:16");
    const Volume& moved = *document.volumes[0].read->volume;
    const glm::dvec3 at = cube.geometry.to_world({1, 2, 3});
    EXPECT_LT(glm::length(moved.geometry.to_world({1, 2, 3}) - glm::dvec3(5 - at.y, 6 + at.x, 7 + 2 * at.z)), 1e-12);
    EXPECT_EQ(moved.checksum, cube.checksum);
    SceneDocument flat = parse(kText);
    flat.volumes[0].volume.transform[10] = 0;
    EXPECT_THAT(refusal([&] { load_scene_volume(flat, {}); }),
                AllOf(HasSubstr("volumes[0]"), HasSubstr("volume.transform"), HasSubstr("inverted")));
    SceneDocument alone =
        parse("volume.path = \"builtin:sphere:20\"\nvolume.transform = [1,0,0,9, 0,1,0,0, 0,0,1,0, 0,0,0,1]");
    EXPECT_EQ(load_scene_volume(alone, {}).geometry.origin, first.geometry.origin + glm::dvec3(9, 0, 0));
}

TEST(SceneVolumes, AreReadOnceUntilTheirSourceChanges) {
    Volume first;
    SceneDocument document = read(kText, first);
    const auto cube = document.volumes[0].read, orbital = document.volumes[1].read;
    document.volumes[1].volume.visible = true;
    document.volumes[0].materials[0].color = {0, 1, 0};
    read_volumes(document, {});
    EXPECT_EQ(document.volumes[0].read, cube);
    EXPECT_EQ(document.volumes[1].read, orbital);
    document.volumes[0].volume.path = "builtin:box:18";
    read_volumes(document, {});
    EXPECT_EQ(document.volumes[0].read->volume->geometry.dims.x, 18);
    document.volumes[1].volume.path = "builtin:nothing";
    EXPECT_THAT(refusal([&] { read_volumes(document, {}); }), HasSubstr("volumes[1]: "));
}

TEST(SceneVolumes, KeepTheirOwnMatter) {
    Volume first;
    const SceneDocument document = read(kText, first);
    const Scene scene = resolve_scene(document, first);
    ASSERT_EQ(scene.added.size(), 2U);
    EXPECT_THAT(scene.iso_values, ElementsAre(0.5));
    EXPECT_THAT(scene.added[0].iso_values, ElementsAre(0.4));
    EXPECT_EQ(scene.added[0].materials[1].color, glm::dvec3(1, 0, 0));
    EXPECT_FALSE(scene.added[0].clipped);
    EXPECT_TRUE(has_matter(scene_of_volume(scene, 0)) && has_matter(scene_of_volume(scene, 1)));
    EXPECT_FALSE(has_matter(scene_of_volume(scene, 2))) << "it is not visible";
    EXPECT_NE(scene.materials[1].color, scene.added[1].materials[1].color) << "other default colours";
    EXPECT_THAT(refusal([] { resolve_scene(parse(kText), builtin_volume("builtin:sphere:20")); }),
                HasSubstr("volumes[0]: builtin:box:16 is not read"));
    EXPECT_EQ(raycast_obstacle(scene), "several volumes");
}

/// What is written out of a picture draws the same picture, and shows a hidden volume again.
TEST(SceneVolumes, AreWrittenOutWithEveryChoice) {
    Volume first;
    SceneDocument document = read(kText, first);
    document.effects.clip.keep.resize(1);
    document.volume.clip = false;
    const Scene scene = resolve_scene(document, first);
    const Camera camera = resolve_camera(document, first, scene);
    const SceneDocument out = resolved(document, first, scene, camera, document.quality.settings);
    EXPECT_EQ(out.effects.clip.keep.size(), 1U);
    EXPECT_FALSE(out.volumes[1].volume.visible);
    EXPECT_FALSE(out.volumes[1].iso_values.empty());
    SceneDocument again = parse(scene_text(out));
    const Volume same = load_scene_volume(again, {});
    const Scene drawn = resolve_scene(again, same);
    EXPECT_EQ(drawn.materials, scene.materials);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(drawn.added[i].iso_values, scene.added[i].iso_values);
        EXPECT_EQ(drawn.added[i].materials, scene.added[i].materials);
    }
    again.volumes[1].volume.visible = true;
    EXPECT_TRUE(has_matter(scene_of_volume(resolve_scene(again, same), 2)));
    // Alone, a clip plane that does not cut is not there, and stays in the file.
    SceneDocument alone = parse("volume.path = \"builtin:sphere:20\"\nvolume.clip = false");
    alone.effects.clip.keep.resize(1);
    const Volume sphere = load_scene_volume(alone, {});
    const Scene whole = resolve_scene(alone, sphere);
    EXPECT_TRUE(whole.effects.clip.empty());
    EXPECT_EQ(resolved(alone, sphere, whole, camera, {}).effects.clip.keep.size(), 1U);
}

/// A volume that replaces the others removes them within its grid, unless it is hidden.
TEST(SceneVolumes, ReplaceTheOthersInside) {
    Volume first;
    SceneDocument document = read(kText, first);
    document.volumes[0].volume.rule = VolumeRule::Inside;
    const Scene scene = resolve_scene(document, first);
    const auto planes = scene_of_volume(scene, 0).effects.clip.remove;
    ASSERT_EQ(planes.size(), 6U);
    const VolumeGeometry& geometry = scene.added[0].volume->geometry;
    const glm::dvec3 last(geometry.dims - 1);
    const auto removed = [&](const glm::dvec3& voxel) {
        return std::ranges::all_of(planes, [&](const Plane& plane) {
            return glm::dot(plane.normal, geometry.to_world(voxel) - plane.point) < 0;
        });
    };
    EXPECT_TRUE(removed(-glm::dvec3(0.49)) && removed(last + 0.49));
    EXPECT_FALSE(removed({-0.51, 1, 1}) || removed({1, last.y + 0.51, 1}) || removed({1, 1, last.z + 0.51}));
    EXPECT_TRUE(scene_of_volume(scene, 1).effects.clip.remove.empty());
    document.volumes[0].volume.visible = false;
    EXPECT_TRUE(scene_of_volume(resolve_scene(document, first), 0).effects.clip.remove.empty());
}

/// Across the rim, one volume's share falls as the other's rises; sides beyond which nothing continues have none.
TEST(SceneVolumes, GiveWayAlongRims) {
    Volume first;
    SceneDocument document = read(kText, first);
    document.volumes[0].volume.rule = VolumeRule::Inside;
    Scene scene = resolve_scene(document, first);
    auto inner = std::make_shared<Volume>(first);
    // The first volume's low half along x, on a grid of half the spacing.
    inner->geometry.index_to_world_axes *= 0.5;
    inner->geometry.dims = first.geometry.dims * glm::ivec3(1, 2, 2);
    inner->geometry.origin = first.geometry.to_world(glm::dvec3(-0.25));
    scene.added[0].volume = inner;
    const auto rim = [&](std::size_t number) { return scene_of_volume(scene, number, first.geometry).rim; };
    const Rim outside = rim(0), within = rim(1);
    EXPECT_TRUE(within.within && !outside.within);
    EXPECT_DOUBLE_EQ(outside.width, 0.5 * std::min(6 * 2 * first.geometry.spacing().x,
                                                   first.geometry.dims.x * 0.5 * first.geometry.spacing().x));
    for (std::size_t side = 0; side < 6; ++side)
        EXPECT_EQ(outside.sides.at(side).inner, side == 1) << side;
    double last = 1;
    const double middle = 0.5 * (first.geometry.dims.y - 1);
    for (double x = 1; x < first.geometry.dims.x; x += 0.25) {
        const glm::dvec3 at = first.geometry.to_world({x, middle, middle});
        EXPECT_NEAR(within.share(at) + outside.share(at), 1, 1e-12);
        EXPECT_LE(within.share(at), last);
        last = within.share(at);
    }
    EXPECT_EQ(last, 0);
    EXPECT_EQ(within.share(first.geometry.to_world({0, middle, middle})), 1);
    scene.added[0].rim = 1;
    EXPECT_DOUBLE_EQ(rim(0).width, 1);
    scene.added[0].replaces = false;
    EXPECT_FALSE(rim(0).any() || rim(1).any());
}

constexpr const char* kCutText = R"(
iso_values = [0.5]
[volume]
path = "builtin:box:20"
opacity = 0.5
[[volumes]]
volume.path = "builtin:sphere:20"
volume.rule = "cut"
volume.transform = [1,0,0,4, 0,1,0,0, 0,0,1,0, 0,0,0,1]
[[volumes]]
iso_values = [0.4]
volume.path = "builtin:torus:20"
)";

/// A volume that cuts is not drawn; matter of the others does not depend on it otherwise.
TEST(SceneVolumes, CutTheOthers) {
    Volume first;
    SceneDocument document = read(kCutText, first);
    const auto box = std::make_shared<const Volume>(builtin_volume("builtin:box:20"));
    EXPECT_NE(first.checksum, box->checksum);
    EXPECT_EQ(document.whole.volume->checksum, box->checksum);
    const Scene scene = resolve_scene(document, first);
    ASSERT_EQ(scene.added.size(), 1U);
    EXPECT_EQ(scene.added[0].volume, document.volumes[1].cut.volume);
    EXPECT_NE(scene.added[0].volume->checksum, document.volumes[1].read->volume->checksum);
    EXPECT_THAT(scene.added[0].iso_values, ElementsAre(0.4));
    const Cutter ball{document.volumes[0].read->volume, 0.5};
    EXPECT_EQ(first.checksum, without_solids(*box, 0.5, {&ball, 1}).checksum);

    Cuts cuts;
    const auto cut = cuts.apply(document, box);
    EXPECT_EQ(cut->checksum, first.checksum);
    EXPECT_EQ(cuts.apply(document, box), cut) << "cut once";
    SceneDocument hidden = document;
    hidden.volumes[0].volume.visible = false;
    EXPECT_EQ(Cuts().apply(hidden, box), box);
    const Scene whole = resolve_scene(hidden, *box);
    EXPECT_EQ(whole.materials, scene.materials) << "the opacity is that of the whole volume";
    EXPECT_EQ(whole.added[0].volume, document.volumes[1].read->volume);
    document.volumes[0].volume.transform[3] = 5;
    read_volumes(document, {});
    SceneDocument again = parse(kCutText);
    again.volumes[0].volume.transform[3] = 5;
    load_scene_volume(again, {});
    EXPECT_EQ(document.volumes[0].read->volume->geometry.origin, again.volumes[0].read->volume->geometry.origin);
    EXPECT_EQ(document.volumes[0].read->source, again.volumes[0].read->source);
    EXPECT_NE(cuts.apply(document, box), cut);
    document.volumes.pop_back();
    EXPECT_NE(cuts.apply(document, box)->checksum, box->checksum);
    EXPECT_EQ(raycast_obstacle(resolve_scene(document, *box)), "");
}

TEST(SceneVolumes, ThatCutAreWrittenOut) {
    Volume first;
    const SceneDocument document = read(kCutText, first);
    const Scene scene = resolve_scene(document, first);
    const Camera camera = resolve_camera(document, first, scene);
    SceneDocument again = parse(scene_text(resolved(document, first, scene, camera, document.quality.settings)));
    EXPECT_EQ(again.volumes[0].volume.rule, VolumeRule::Cut);
    const Volume same = load_scene_volume(again, {});
    EXPECT_EQ(same.checksum, first.checksum);
    EXPECT_EQ(resolve_scene(again, same).added[0].volume->checksum, scene.added[0].volume->checksum);
    EXPECT_EQ(resolve_scene(again, same).materials, scene.materials);
}

TEST(SceneVolumes, ThatCutNeedValuesWithoutMatter) {
    EXPECT_THAT(problems("volume.path = \"builtin:sphere\"\nvolume.rule = \"cut\"\n"),
                Contains(AllOf(HasSubstr("a.toml:2: volume.rule"), HasSubstr("\"cut\""))));
    const std::string cutter = "[[volumes]]\nvolume.path = \"builtin:sphere:20\"\nvolume.rule = \"cut\"\n";
    EXPECT_THAT(problems("volume.path = \"builtin:box\"\noutput.renderer = \"raycast\"\n" + cutter),
                testing::IsEmpty());
    EXPECT_THAT(problems("volume.path = \"builtin:box\"\noutput.renderer = \"truth\"\n" + cutter),
                Contains(HasSubstr("others cut it")));
    const auto refused = [&](const std::string& matter) {
        Volume first;
        return refusal([&] { read("volume.path = \"builtin:box:20\"\n" + matter + cutter, first); });
    };
    EXPECT_THAT(refused("below.extinction = 1\niso_values = [0.5]\n"), HasSubstr("below the lowest iso-value"));
    const auto point = [](double value, double extinction) {
        return fmt::format("[[transfer]]\nvalue = {}\ncolor = [1, 1, 1]\nextinction = {}\n", value, extinction);
    };
    EXPECT_THAT(refused(point(0, 1) + point(1, 2)), HasSubstr("lowest values"));
    EXPECT_EQ(refused(point(0, 0) + point(0.2, 0) + point(1, 2)), "");
}

/// A named view frames the matter of all volumes.
TEST(SceneVolumes, AreAllInThePicture) {
    Volume first;
    const SceneDocument near = read("volume.path = \"builtin:sphere:20\"", first);
    const double alone = glm::length(resolve_camera(near, first, resolve_scene(near, first)).eye);
    const SceneDocument far = read(
        "volume.path = \"builtin:sphere:20\"\n[[volumes]]\nvolume.path = \"builtin:sphere:20\"\n"
        "volume.transform = [1,0,0,100, 0,1,0,0, 0,0,1,0, 0,0,0,1]\n",
        first);
    EXPECT_GT(glm::length(resolve_camera(far, first, resolve_scene(far, first)).eye), 2 * alone);
}

/// A ball of radius 20, flattened to 10 mm along z by its grid.
Volume flat_ball() {
    Volume volume;
    volume.geometry.dims = glm::ivec3(50);
    volume.geometry.index_to_world_axes[2] = {0, 0, 0.5};
    for (int i = 0; i < 50 * 50 * 50; ++i)
        volume.values.push_back(
            glm::length(glm::dvec3(i % 50, i / 50 % 50, i / 2500) - glm::dvec3(24.4, 24.7, 24.6)) < 20 ? 1 : 0);
    finish_volume(volume);
    return volume;
}

TEST(SceneVolumes, HaveAnOpacityInTheMeanOfTheirChords) {
    const Volume box = builtin_volume("builtin:box:32");
    // Six volumes by the sum of the sides' areas: an ellipsoid's are twice its shadows, pi times 20 * 20 and 20 * 10.
    EXPECT_NEAR(mean_chord(flat_ball(), 0.5), 6 * (4.0 / 3 * 20 * 20 * 10) / (2 * (400 + 2 * 200)), 0.05);
    SceneDocument document = parse("volume.path = \"builtin:box:32\"\nvolume.opacity = 0.4");
    const Scene scene = resolve_scene(document, box);
    EXPECT_NEAR(-std::expm1(-scene.materials.back().extinction * mean_chord(box, scene.iso_values.front())), 0.4,
                1e-12);
    document.volume.opacity = 1;
    EXPECT_EQ(resolve_scene(document, box).materials.back().extinction, default_extinction(true, box.geometry));
    document.materials = {{.extinction = 1}};
    EXPECT_THAT(refusal([&] { resolve_scene(document, box); }),
                AllOf(HasSubstr("volume.opacity"), HasSubstr("materials[0]")));
    EXPECT_THAT(problems("volume.path = \"builtin:box\"\nvolume.opacity = 1.5"), Contains(HasSubstr("volume.opacity")));
}

TEST(SceneVolumes, ShowFadedLabelsAlone) {
    SceneDocument document = parse("volume.path = \"builtin:box\"\nvolume.hide = [\"skull\"]");
    const SceneDocument before = document;
    fade_labels(document, "lung*", 0.5);
    fade_labels(document, "7", 0.2);
    fade_labels(document, "lung*", 0.3);
    ASSERT_EQ(document.volumes.size(), 2U);
    EXPECT_THAT(document.volume.hide, ElementsAre("skull", "lung*", "7"));
    EXPECT_THAT(document.volumes[0].volume.only, ElementsAre("lung*"));
    EXPECT_THAT(document.volumes[0].volume.hide, ElementsAre("skull", "7")) << "no voxel is shown twice";
    EXPECT_EQ(document.volumes[0].volume.opacity, 0.3);
    EXPECT_EQ(opacity_of_labels(document, "7"), 0.2);
    EXPECT_EQ(parse(scene_text(document)), document);
    fade_labels(document, "7", 1);
    fade_labels(document, "lung*", 1);
    EXPECT_EQ(document, before);
    fade_labels(document, "*", 0.6);
    EXPECT_EQ(document.volume.opacity, 0.6);
    EXPECT_TRUE(document.volumes.empty());
}

}  // namespace
}  // namespace edgesplat

// Editing iso-values: order, limits, and each value keeps its material.
#include "engine/viewer/iso_edit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/scene/default_materials.h"
#include "tests/unit/viewer_random.h"
#include "tests/unit/viewer_volumes.h"

namespace edgesplat::viewer {
namespace {

using namespace viewer_test;

/// Values from 0 to 1.
Volume volume() {
    Volume v = *sampled(hollow_ball(16, 5));
    v.min_value = 0;
    v.max_value = 1;
    return v;
}

MaterialChoice named(const std::string& name) {
    MaterialChoice material = choice_of(Material{});
    material.name = name;
    return material;
}

SceneDocument document(const std::vector<double>& iso) {
    SceneDocument d;
    d.iso_values = iso;
    for (std::size_t i = 0; i < iso.size(); ++i)
        d.materials.push_back(named(std::string(1, static_cast<char>('a' + i))));
    return d;
}

std::string names(const SceneDocument& d) {
    std::string all;
    for (const MaterialChoice& m : d.materials)
        all += m.name.empty() ? "-" : m.name;
    return all;
}

TEST(IsoEdit, InsertsValuesInOrderWithOwnMaterial) {
    const Volume v = volume();
    SceneDocument d = document({0.3, 0.6});
    d.materials[0].color = default_color(0);
    EXPECT_EQ(add_iso_value(d, v, 0.5), 1U);
    EXPECT_EQ(d.iso_values, (std::vector{0.3, 0.5, 0.6}));
    EXPECT_EQ(names(d), "a-b");
    EXPECT_EQ(d.materials[1].color, default_color(1));
    EXPECT_EQ(d.materials[1].extinction, default_extinction(false, v.geometry));
    EXPECT_EQ(add_iso_value(d, v, 0.9), 3U);
    EXPECT_EQ(d.materials[3].color, default_color(2));
    EXPECT_EQ(d.materials[3].extinction, default_extinction(true, v.geometry));
    EXPECT_NO_THROW(resolve_scene(d, v));
}

TEST(IsoEdit, AddedValuesStayInRangeAndApart) {
    const Volume v = volume();
    SceneDocument d = document({0.5});
    ASSERT_TRUE(add_iso_value(d, v, 0.5));
    ASSERT_TRUE(add_iso_value(d, v, 0.5));
    for (const int i : {0, 1, 2})
        EXPECT_NEAR(d.iso_values[static_cast<std::size_t>(i)], 0.5 + (i - 1) * kIsoGap, 1e-12);
    ASSERT_EQ(add_iso_value(d, v, -7), 0U);
    EXPECT_GT(d.iso_values[0], 0);
    ASSERT_EQ(add_iso_value(d, v, 7), 4U);
    EXPECT_EQ(d.iso_values[4], 1);
    EXPECT_FALSE(add_iso_value(d, v, std::nan("")));
    EXPECT_FALSE(add_iso_value(d, v, std::numeric_limits<double>::infinity()));
    while (d.iso_values.size() < kMaxIsoValues)
        ASSERT_TRUE(add_iso_value(d, v, 1));
    EXPECT_FALSE(add_iso_value(d, v, 0.7));
    EXPECT_NO_THROW(resolve_scene(d, v));
}

TEST(IsoEdit, RefusesValuesInConstantVolume) {
    Volume v = volume();
    v.min_value = v.max_value = 3;
    SceneDocument d;
    d.transfer = {{0, glm::dvec3(1), 1}};
    EXPECT_FALSE(add_iso_value(d, v, 3));
}

TEST(IsoEdit, MovedValueKeepsItsMaterial) {
    const Volume v = volume();
    SceneDocument d = document({0.2, 0.4, 0.6});
    EXPECT_EQ(move_iso_value(d, v, 0, 0.3), 0U);
    EXPECT_EQ(names(d), "abc");
    EXPECT_EQ(move_iso_value(d, v, 0, 0.5), 1U);
    EXPECT_EQ(names(d), "bac");
    EXPECT_EQ(d.iso_values, (std::vector{0.4, 0.5, 0.6}));
    EXPECT_EQ(move_iso_value(d, v, 1, 0.95), 2U);
    EXPECT_EQ(names(d), "bca");
    EXPECT_EQ(move_iso_value(d, v, 2, -5), 0U);
    EXPECT_EQ(names(d), "abc");
    EXPECT_NEAR(d.iso_values[0], kIsoGap, 1e-12);
    const SceneDocument before = d;
    EXPECT_EQ(move_iso_value(d, v, 1, std::nan("")), 1U);
    EXPECT_EQ(d, before);
}

TEST(IsoEdit, MovedValueStopsBesideEqualOne) {
    const Volume v = volume();
    SceneDocument d = document({0.2, 0.4});
    const std::size_t at = move_iso_value(d, v, 0, 0.4);
    EXPECT_NEAR(std::abs(d.iso_values[0] - d.iso_values[1]), kIsoGap, 1e-12);
    EXPECT_EQ(d.materials[at].name, "a");
}

TEST(IsoEdit, KeepsLastValueWithoutTransferFunction) {
    SceneDocument d = document({0.2, 0.4, 0.6});
    EXPECT_TRUE(remove_iso_value(d, 1));
    EXPECT_EQ(names(d), "ac");
    EXPECT_TRUE(remove_iso_value(d, 0));
    EXPECT_FALSE(remove_iso_value(d, 0));
    EXPECT_FALSE(remove_iso_value(d, 1));
    d.transfer = {{0, glm::dvec3(1), 1}};
    EXPECT_TRUE(remove_iso_value(d, 0));
    EXPECT_TRUE(d.iso_values.empty());
    EXPECT_NO_THROW(resolve_scene(d, volume()));
}

TEST(IsoEdit, RandomEditsKeepSceneValid) {
    const Volume v = volume();
    Random random(5);
    const auto uniform = [&] { return random(0, 1); };
    SceneDocument d = document({0.5});
    for (int i = 0; i < 3000; ++i) {
        const double value = std::round((uniform() * 1.4 - 0.2) * 50) / 50;
        const auto place = static_cast<std::size_t>(uniform() * static_cast<double>(d.iso_values.size()));
        const double what = uniform();
        if (what < 0.2)
            add_iso_value(d, v, value);
        else if (what < 0.3)
            remove_iso_value(d, place);
        else
            move_iso_value(d, v, place, value);
        ASSERT_EQ(d.iso_values.size(), d.materials.size());
        ASSERT_NO_THROW(resolve_scene(d, v)) << i;
        ASSERT_TRUE(std::ranges::is_sorted(d.iso_values));
    }
}

TEST(IsoEdit, PresetSetsIsoValueIfInRange) {
    Volume v = volume();
    SceneDocument d = document({0.2, 0.4});
    ScenePreset bone{"ct-bone", "built in", {}};
    bone.content.iso_values = {300};
    bone.content.materials = {{.color = glm::dvec3(0.9, 0.8, 0.7), .extinction = 8.0, .specular = 0.25}};
    EXPECT_EQ(apply_material_preset(d, v, 1, bone), 1U);
    EXPECT_EQ(d.iso_values, (std::vector{0.2, 0.4}));
    EXPECT_EQ(d.materials[0].name, "ct-bone");
    EXPECT_EQ(d.materials[0].specular, 0.25);
    EXPECT_EQ(d.materials[0].diffuse, 1.0);
    bone.content.iso_values = {0.5};
    EXPECT_EQ(apply_material_preset(d, v, 1, bone), 2U);
    EXPECT_EQ(d.iso_values, (std::vector{0.4, 0.5}));
    EXPECT_EQ(names(d), "bct-bone");
    EXPECT_EQ(apply_material_preset(d, v, 0, bone), 0U);
    EXPECT_EQ(d.below.extinction, 8.0);
    bone.content.materials.clear();
    const SceneDocument before = d;
    EXPECT_EQ(apply_material_preset(d, v, 1, bone), 1U);
    EXPECT_EQ(d, before);
}

TEST(IsoEdit, WrittenOutMaterialsGiveTheSameScene) {
    const Volume v = volume();
    SceneDocument d;
    d.iso_values = {0.6, 0.3};
    const Scene scene = resolve_scene(d, v);
    write_out_materials(d, scene, v);
    EXPECT_EQ(d.iso_values, scene.iso_values);
    const Scene again = resolve_scene(d, v);
    EXPECT_EQ(again.iso_values, scene.iso_values);
    EXPECT_EQ(again.materials, scene.materials);
}

}  // namespace
}  // namespace edgesplat::viewer

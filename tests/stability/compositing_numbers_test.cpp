// Numbers that are none: said by the pass and the splat where they come about, and looked for only when asked.
#include <limits>

#include "tests/passes/pass_fixture.h"
#include "tests/stability/hazard.h"

namespace edgesplat::test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// A torus in which one voxel, (13, 12, 15), is of a material of its own.
PassScene one_of_its_own() {
    PassScene s = pass_scenes()[0];
    s.volume.values[static_cast<std::size_t>((15 * 26 + 12) * 28 + 13)] = 3;
    finish_volume(s.volume);
    s.scene.iso_values = {0.5, 2};
    s.scene.materials.push_back({{1, 1, 1}, 1});
    return s;
}

std::string said_of(const PassScene& s) {
    DeviceUnderTest& state = prepared(s);
    state.orders.check_numbers = true;
    std::string said;
    try {
        state.draw(s.scene, s.camera, s.settings, {40, 40}, shader::PAYLOAD_COLOR);
    } catch (const Error& error) {
        said = error.what();
    }
    state.orders.check_numbers = false;
    return said;
}

TEST(CompositingNumbers, OfASoundPictureNothingIsSaid) {
    EXPECT_EQ(said_of(one_of_its_own()), "");
}

TEST(CompositingNumbers, TheSplatThatDrawsThemIsNamed) {
    // Past all checks of what comes in: a colour that is none.
    PassScene s = one_of_its_own();
    s.scene.materials[2].color = {1, kNaN, 1};
    for (const SheetFormat format : {SheetFormat::Tiles, SheetFormat::Layers}) {
        s.settings.sheet_format = format;
        const std::string said = said_of(s);
        EXPECT_TRUE(said.starts_with(format == SheetFormat::Tiles ? "5_draw_tiles: splat " : "5_draw_splats: splat "))
            << said;
        EXPECT_NE(said.find("; material 2): pixel "), std::string::npos) << said;
        EXPECT_NE(said.find("channel 1 is nan, expected a finite number"), std::string::npos) << said;
    }
}

TEST(CompositingNumbers, WhatIsThereWithoutSplatsIsNamed) {
    PassScene s = one_of_its_own();
    s.scene.background = {0, 0, kNaN};
    const std::string said = said_of(s);
    EXPECT_TRUE(said.starts_with("7_resolve: pixel 0, 0, channel 2 is nan")) << said;
}

TEST(CompositingNumbers, ASplatClassifiedByNoneIsNamed) {
    PassScene s = one_of_its_own();
    s.scene.iso_values.clear();
    s.scene.materials = {{}};
    s.scene.transfer = {{0.2, {1, 0, 0}, 0}, {0.6, {1, 1, 1}, 3}};
    DeviceUnderTest& state = prepared(s);
    const gpu::Buffer bad(state.device(), sizeof(float), gpu::Buffer::Place::Host, "no number");
    bad.mapped<float>(1)[0] = std::numeric_limits<float>::quiet_NaN();
    state.commands().run([&] {
        state.commands().copy(bad, state.lists().values, {{0, 17 * sizeof(float), sizeof(float)}});
    });
    try {
        check_splats(state.session, state.level);
        ADD_FAILURE() << "not seen";
    } catch (const Error& error) {
        EXPECT_TRUE(std::string(error.what()).starts_with("2_collect_splats: splat 17 of ")) << error.what();
    }
    state.level.splats.drop();
}

TEST(CompositingNumbers, NotAskedForNothingIsReadBack) {
    const PassScene s = one_of_its_own();
    DeviceUnderTest& state = prepared(s);
    state.device().forget_peaks();
    state.draw(s.scene, s.camera, s.settings, {40, 40}, shader::PAYLOAD_COLOR);
    for (const auto& [name, allocation] : state.device().allocations())
        EXPECT_NE(name, "read back");
}

}  // namespace
}  // namespace edgesplat::test

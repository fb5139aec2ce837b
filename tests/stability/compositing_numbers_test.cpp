// Non-finite numbers: reported with the pass and splat of their origin, and searched only on request.
#include <limits>

#include "tests/passes/pass_fixture.h"
#include "tests/stability/hazard.h"

namespace edgesplat::test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// A torus in which one voxel, (13, 12, 15), has its own material.
PassScene torus_with_special_voxel() {
    PassScene s = pass_scenes()[0];
    s.volume.values[static_cast<std::size_t>((15 * 26 + 12) * 28 + 13)] = 3;
    finish_volume(s.volume);
    s.scene.iso_values = {0.5, 2};
    s.scene.materials.push_back({{1, 1, 1}, 1});
    return s;
}

std::string message_of(const PassScene& s) {
    DeviceUnderTest& state = prepared(s);
    state.options.check_numbers = true;
    std::string message;
    try {
        state.draw(s.scene, s.camera, s.settings, {40, 40}, shader::PAYLOAD_COLOR);
    } catch (const Error& error) {
        message = error.what();
    }
    state.options.check_numbers = false;
    return message;
}

TEST(CompositingNumbers, IsSilentForValidPictures) {
    EXPECT_EQ(message_of(torus_with_special_voxel()), "");
}

TEST(CompositingNumbers, NamesTheSplatThatDrawsThem) {
    // A NaN colour, set after all input checks.
    PassScene s = torus_with_special_voxel();
    s.scene.materials[2].color = {1, kNaN, 1};
    for (const SheetFormat format : {SheetFormat::Tiles, SheetFormat::Layers}) {
        s.settings.sheet_format = format;
        const std::string message = message_of(s);
        EXPECT_TRUE(
            message.starts_with(format == SheetFormat::Tiles ? "5_draw_tiles: splat " : "5_draw_splats: splat "))
            << message;
        EXPECT_NE(message.find("; material 2): pixel "), std::string::npos) << message;
        EXPECT_NE(message.find("channel 1 is nan, expected a finite number"), std::string::npos) << message;
    }
}

TEST(CompositingNumbers, NamesThePassWithoutSplats) {
    PassScene s = torus_with_special_voxel();
    s.scene.background = {0, 0, kNaN};
    const std::string message = message_of(s);
    EXPECT_TRUE(message.starts_with("7_resolve: pixel 0, 0, channel 2 is nan")) << message;
}

TEST(CompositingNumbers, NamesASplatWithANonFiniteValue) {
    PassScene s = torus_with_special_voxel();
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
        check_splats(state.session, state.level.all());
        ADD_FAILURE() << "the NaN was not reported";
    } catch (const Error& error) {
        EXPECT_TRUE(std::string(error.what()).starts_with("2_collect_splats: splat 17 of ")) << error.what();
    }
    state.level.splats.drop();
}

TEST(CompositingNumbers, ReadsNothingBackWhenOff) {
    const PassScene s = torus_with_special_voxel();
    DeviceUnderTest& state = prepared(s);
    state.device().forget_peaks();
    state.draw(s.scene, s.camera, s.settings, {40, 40}, shader::PAYLOAD_COLOR);
    for (const auto& [name, allocation] : state.device().allocations())
        EXPECT_NE(name, "read back");
}

}  // namespace
}  // namespace edgesplat::test

// An effect that is off costs nothing in the frame: every row of the table of effects is drawn with and without.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cctype>
#include <iterator>
#include <numeric>

#include "engine/forecast/forecast.h"
#include "engine/gpu/shader.h"
#include "tests/passes/pass_fixture.h"
#include "tests/passes/spirv_module.h"

namespace edgesplat::test {
namespace {

/// The passes, pipelines and memory of one picture.
struct FrameCost {
    std::vector<gpu::PipelineVariant> variants;
    std::set<std::string> passes;
    std::map<std::string, std::uint64_t> memory;
    std::uint64_t splats = 0;
};

std::uint64_t total(const FrameCost& frame) {
    return std::accumulate(frame.memory.begin(), frame.memory.end(), std::uint64_t{0},
                           [](std::uint64_t sum, const auto& entry) { return sum + entry.second; });
}

FrameRequest request_for_rows() {
    const PassScene scene = pass_scenes().front();
    return plain_request(
        {std::make_shared<Volume>(scene.volume), scene.scene, scene.camera, scene.settings, {40, 40}, {}});
}

/// Draws the picture and its extra outputs in a renderer without data of other pictures.
FrameCost draw(const FrameRequest& request) {
    DeviceUnderTest& state = device_under_test();
    state.drawer.targets().drop();
    state.level = LevelStore(state.session);
    state.device().forget_peaks();
    state.session.pipelines().forget_used();
    state.level.volume.hold(request.volume, 0);
    const Settings settings = drawn_settings(request);
    state.collect(request.scene, settings, keeps_buried(request));
    FrameCost frame;
    for (const PassTime& pass : state.cost.times)
        frame.passes.insert(pass.name);
    for (const std::uint32_t payload : payloads_of(request.outputs)) {
        state.draw(request.scene, request.camera, settings, request.size, payload);
        for (const PassTime& pass : state.drawer.times())
            frame.passes.insert(pass.name);
    }
    frame.variants = state.session.pipelines().used();
    for (const auto& [name, allocation] : state.device().allocations())
        if (!name.empty() && allocation.bytes > 0) frame.memory[name] = allocation.bytes;
    frame.splats = state.lists().splat_count;
    return frame;
}

/// The values of a constant in the shaders of a frame; empty if no shader has it.
std::set<std::uint32_t> values_of(const FrameCost& frame, std::uint32_t id) {
    std::set<std::uint32_t> values;
    for (const auto& variant : frame.variants)
        for (const auto& [constant, value] : variant.constants)
            if (constant == id) values.insert(value);
    return values;
}

/// Members of FrameParams, VolumeParams and SceneParams that the frame's shaders read, and their numbers of
/// instructions.
struct Code {
    std::set<std::string> members;
    std::map<std::string, std::size_t> instructions;
};

Code code_of(const FrameCost& frame) {
    static std::map<std::string, std::pair<std::set<std::string>, std::size_t>> known;
    Code code;
    for (const auto& variant : frame.variants) {
        for (const char* shader : variant.shaders) {
            std::string key = shader;
            for (const auto& [id, value] : variant.constants)
                key += fmt::format(" {}={}", id, value);
            if (!known.contains(key)) {
                const auto module = specialised(gpu::find_shader(shader), variant.constants);
                known[key] = {members_read(module), instruction_count(module)};
            }
            const auto& [members, instructions] = known[key];
            code.members.insert(members.begin(), members.end());
            code.instructions[shader] += instructions;
        }
    }
    return code;
}

class ZeroCost : public testing::TestWithParam<std::size_t> {
  protected:
    void SetUp() override {
        if (effect().name == "refined pixels" && !device_under_test().device().profile().refines)
            GTEST_SKIP() << "this device draws every pixel";
        try {
            need_layers(device_under_test().device(), with().scene, with().settings);
        } catch (const Error& error) {
            GTEST_SKIP() << error.what();
        }
    }
    const Effect& effect() const { return effect_table()[GetParam()]; }

    FrameRequest without() const {
        FrameRequest request = request_for_rows();
        if (effect().base != nullptr) effect().base(request);
        return request;
    }
    FrameRequest with() const {
        FrameRequest request = without();
        effect().turn_on(request);
        return request;
    }
};

std::set<std::string> strings(const std::vector<std::string_view>& names) {
    return {names.begin(), names.end()};
}

TEST_P(ZeroCost, HasNoPassBufferOrBytesWhenOff) {
    const FrameCost off = draw(without()), on = draw(with());
    std::set<std::string> more_passes;
    std::ranges::set_difference(on.passes, off.passes, std::inserter(more_passes, more_passes.end()));
    EXPECT_EQ(more_passes, strings(effect().passes));

    std::set<std::string> more_memory, resized;
    for (const auto& [name, bytes] : on.memory) {
        const auto before = off.memory.find(name);
        if (before == off.memory.end())
            more_memory.insert(name);
        else if (before->second != bytes)
            resized.insert(name);
    }
    for (const auto& [name, bytes] : off.memory)
        EXPECT_TRUE(on.memory.contains(name)) << name;
    EXPECT_EQ(more_memory, strings(effect().resources));
    EXPECT_THAT(strings(effect().resized), testing::IsSupersetOf(resized));

    // Nothing else differs: the difference in bytes is the effect's own.
    std::int64_t share = 0;
    for (const auto& names : {more_memory, resized})
        for (const std::string& name : names) {
            const auto before = off.memory.find(name);
            share += static_cast<std::int64_t>(on.memory.at(name)) -
                     static_cast<std::int64_t>(before == off.memory.end() ? 0 : before->second);
        }
    EXPECT_EQ(static_cast<std::int64_t>(total(on)) - static_cast<std::int64_t>(total(off)), share);

    // Afterwards everything of the effect is gone.
    const FrameCost again = draw(without());
    EXPECT_EQ(again.memory, off.memory);
    EXPECT_EQ(again.passes, off.passes);
}

TEST_P(ZeroCost, HasNoShaderInstructionWhenOff) {
    const FrameCost off = draw(without()), on = draw(with());
    for (const EffectConstant& constant : effect().constants) {
        const auto off_values = values_of(off, constant.id), on_values = values_of(on, constant.id);
        EXPECT_THAT(off_values, testing::AnyOf(testing::IsEmpty(), testing::ElementsAre(constant.off)))
            << constant.name;
        EXPECT_NE(off_values, on_values) << constant.name;
    }
    const Code off_code = code_of(off), on_code = code_of(on);
    const auto check = [&](const std::vector<std::string_view>& fields, const std::string& structure) {
        for (const std::string_view field : fields) {
            const std::string member = structure + "." + std::string(field);
            EXPECT_FALSE(off_code.members.contains(member)) << member << " is read without the effect";
            EXPECT_TRUE(on_code.members.contains(member)) << member << " is not read with the effect";
        }
    };
    check(effect().frame_fields, "FrameParams");
    check(effect().volume_fields, "VolumeParams");
    check(effect().scene_fields, "SceneParams");
    const bool reads = !effect().frame_fields.empty() || !effect().volume_fields.empty();
    if (reads || !effect().scene_fields.empty()) {
        std::size_t off_total = 0, on_total = 0;
        for (const auto& [shader, count] : off_code.instructions)
            off_total += count;
        for (const auto& [shader, count] : on_code.instructions)
            on_total += count;
        // Surface splats replace kernels, whose shaders are longer.
        if (effect().name == "surface splats") return;
        EXPECT_LT(off_total, on_total) << "the effect adds no instructions";
    }
}

INSTANTIATE_TEST_SUITE_P(Effects, ZeroCost, testing::Range(std::size_t{0}, effect_table().size()),
                         [](const testing::TestParamInfo<std::size_t>& variant) {
                             std::string name(effect_table()[variant.param].name);
                             std::erase_if(name,
                                           [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; });
                             return name;
                         });

TEST(PlainFrame, ReadsNoMemberOwnedByAnEffect) {
    const Code code = code_of(draw(request_for_rows()));
    for (const Effect& effect : effect_table()) {
        for (const std::string_view field : effect.frame_fields)
            EXPECT_FALSE(code.members.contains("FrameParams." + std::string(field))) << effect.name << ": " << field;
        for (const std::string_view field : effect.volume_fields)
            EXPECT_FALSE(code.members.contains("VolumeParams." + std::string(field))) << effect.name << ": " << field;
        for (const std::string_view field : effect.scene_fields)
            EXPECT_FALSE(code.members.contains("SceneParams." + std::string(field))) << effect.name << ": " << field;
    }
}

TEST(PlainFrame, ChecksCanFail) {
    const Code code = code_of(draw(request_for_rows()));
    EXPECT_TRUE(code.members.contains("FrameParams.background"));
    EXPECT_TRUE(code.members.contains("VolumeParams.splats"));
    EXPECT_TRUE(code.members.contains("SceneParams.core_size"));
}

}  // namespace
}  // namespace edgesplat::test

// The description of a frame equals what the device runs and holds; a frame that does not fit is refused in advance.
#include <gmock/gmock.h>

#include <algorithm>
#include <map>

#include "engine/error.h"
#include "engine/forecast/description.h"
#include "engine/forecast/forecast.h"
#include "engine/scene/ladder.h"
#include "tests/properties/scenes.h"

namespace edgesplat::test {
namespace {

using ::testing::HasSubstr;

FrameRequest described_request() {
    const Shot shot = torus_shot();
    return {shot.volume, shot.scene, shot.camera, shot.settings, {48, 40}, {}};
}

RenderStats draw(const FrameRequest& r) {
    return test_renderer().render(r.scene, r.camera, r.settings, r.size.x, r.size.y, r.outputs).stats;
}

/// Draws the request in a renderer without data of other pictures, and compares.
void expect_described(const FrameRequest& request, const std::string& what) {
    SCOPED_TRACE(what);
    Renderer& renderer = test_renderer();
    renderer.set_volume(nullptr);
    renderer.set_volume(request.volume);
    const FrameDescription before = describe_frame(request, renderer);
    const RenderStats stats = draw(request);

    std::map<std::string, std::uint64_t> described, held;
    for (const ResourceDescription& resource : before.resources)
        described[resource.name] = std::max(described[resource.name], *resource.device_bytes);
    for (const MemoryUse& use : stats.memory)
        held[use.name] = use.bytes;
    EXPECT_EQ(described, held);

    std::vector<std::string> expected, ran;
    const auto has_run = [&](const std::string& name) {
        return std::ranges::any_of(stats.passes, [&](const PassTime& pass) { return pass.name == name; });
    };
    for (const PassDescription& pass : before.passes) {
        if (pass.depends && !has_run(pass.name)) continue;
        const bool extra = pass.draw != "setup" && pass.draw != "colour";
        expected.push_back(extra ? pass.draw + ": " + pass.name : pass.name);
        EXPECT_FALSE(pass.reason.empty());
    }
    for (const PassTime& pass : stats.passes)
        ran.push_back(pass.name);
    EXPECT_EQ(expected, ran);
    EXPECT_EQ(before.splats, stats.splats_collected);
    EXPECT_EQ(before.sheets, stats.sheets);
    EXPECT_EQ(before.sheet_groups, stats.sheet_groups);

    const FrameDescription after = describe_frame(request, renderer, &stats);
    EXPECT_GE(after.total_bytes(), stats.device_bytes);
    for (const PassDescription& pass : after.passes)
        EXPECT_TRUE(pass.measured_milliseconds.has_value()) << pass.name;
    for (const ResourceDescription& resource : after.resources)
        if (resource.allocated_bytes) {
            EXPECT_EQ(resource.allocated_bytes, resource.device_bytes) << resource.name;
        }
}

TEST(FrameDescription, MatchesTheDeviceForEveryEffect) {
    expect_described(plain_request(described_request()), "plain");
    for (const Effect& effect : effect_table()) {
        FrameRequest request = plain_request(described_request());
        if (effect.base != nullptr) effect.base(request);
        effect.turn_on(request);
        expect_described(request, std::string(effect.name));
    }
}

TEST(FrameDescription, MatchesTheDeviceForUsualPictures) {
    FrameRequest request = described_request();
    expect_described(request, "default");
    request.settings = preset_named("accurate").settings;
    expect_described(request, "accurate");
    request.settings = preset_named("draft").settings;
    request.outputs = {true, true, true, true};
    expect_described(request, "draft with every output");
}

TEST(FrameDescription, BoundsTheNumberOfSplats) {
    // At a jump of values a voxel has opaque matter of its own, and carries the matter between its samples.
    FrameRequest r = described_request();
    r.volume = sampled(glm::ivec3(12), [](const glm::dvec3& x) {
        const int i = static_cast<int>(x.x + 3 * x.y + 7 * x.z);
        return i % 5 < 3 ? 1.0 : i % 5 == 3 ? 0.5 : 0.0;
    });
    r.scene.iso_values = {0.4, 0.6};
    r.scene.materials = {{}, {{1, 1, 1}, 0.1}, {{1, 1, 1}, 8}};
    r.settings.cull_buried = false;
    const CollectionPlan plan = planned_collection(r);
    const std::uint64_t counted = count_splats(*r.volume, plan).extent.count;
    EXPECT_GT(counted, std::uint64_t{12 * 12 * 12});
    EXPECT_LE(counted, most_splats(plan).extent.count);
    expect_described(r, "jumps");
}

TEST(FrameDescription, StatesReasonsAndTheCostOfInactiveEffects) {
    FrameRequest request = plain_request(described_request());
    const FrameDescription plain = describe_frame(request);
    EXPECT_TRUE(plain.active_effects.empty());
    EXPECT_EQ(plain.left_out.size(), effect_table().size());
    for (const ResourceDescription& resource : plain.resources)
        EXPECT_EQ(resource.reason, "every picture") << resource.name;

    request.scene.lights = {Light{}};
    const FrameDescription lit = describe_frame(request);
    EXPECT_EQ(lit.left_out.size() + lit.active_effects.size(), effect_table().size());
    const auto edges = std::ranges::find(lit.resources, "edge field", &ResourceDescription::name);
    ASSERT_NE(edges, lit.resources.end());
    EXPECT_EQ(edges->reason, "light: lights[0] is a headlight");
    const auto priced = std::ranges::find(plain.left_out, "light", &LeftOut::effect);
    ASSERT_NE(priced, plain.left_out.end());
    EXPECT_EQ(priced->bytes, static_cast<std::int64_t>(edges->bytes));
    EXPECT_EQ(priced->passes, std::vector<std::string>{"1_estimate_edges"});

    const std::string text = to_text(lit);
    EXPECT_THAT(text, HasSubstr("edge field"));
    EXPECT_THAT(text, HasSubstr("light: lights[0] is a headlight"));
    EXPECT_THAT(text, HasSubstr("7_resolve.comp PAYLOAD=0"));
    EXPECT_THAT(text, HasSubstr("splat record, 12 bytes"));
}

class MemoryBudget : public testing::Test {
  protected:
    ~MemoryBudget() override { test_renderer().set_memory_budget(0); }
    static std::uint64_t held() {
        Renderer& renderer = test_renderer();
        return renderer.held_bytes();
    }
    static std::string refusal(const FrameRequest& request) {
        try {
            draw(request);
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    }
};

TEST_F(MemoryBudget, RefusesAPictureBeforeAllocation) {
    FrameRequest request = described_request();
    request.size = {160, 120};
    Renderer& renderer = test_renderer();
    renderer.set_volume(nullptr);
    renderer.set_volume(request.volume);
    renderer.set_memory_budget(2 << 20);
    const std::uint64_t before = held();
    const std::string message = refusal(request);
    EXPECT_EQ(held(), before);
    EXPECT_THAT(message, HasSubstr("2.00 MiB are available (the memory budget)"));
    EXPECT_THAT(message, HasSubstr("edge field"));
    EXPECT_THAT(message, HasSubstr("tile entries"));
    EXPECT_THAT(message, HasSubstr("--size"));

    // The stated amount is enough; one byte less is not.
    const std::uint64_t needed = describe_frame(request, renderer).total_bytes();
    renderer.set_memory_budget(needed - 1);
    EXPECT_NE(refusal(request), "");
    renderer.set_memory_budget(needed);
    EXPECT_EQ(refusal(request), "");
    EXPECT_LE(draw(request).device_bytes, needed);
}

TEST_F(MemoryBudget, OffersOnlyChangesThatFit) {
    FrameRequest request = described_request();
    request.size = {160, 120};
    request.settings.sheets = SheetCut::Sliced;
    request.outputs.tau = true;
    Renderer& renderer = test_renderer();
    renderer.set_volume(nullptr);
    renderer.set_volume(request.volume);
    const std::uint64_t needed = describe_frame(request, renderer).total_bytes();
    for (const double share : {0.9, 0.6, 0.35}) {
        const auto budget = static_cast<std::uint64_t>(share * static_cast<double>(needed));
        renderer.set_memory_budget(budget);
        const auto offers = renderer.fitting_changes(request);
        EXPECT_FALSE(offers.empty()) << share;
        for (const auto& [text, changed] : offers) {
            SCOPED_TRACE(text);
            renderer.set_volume(changed.volume);
            EXPECT_EQ(refusal(changed), "");
            EXPECT_LE(held(), budget);
            renderer.set_volume(request.volume);
        }
        EXPECT_NE(refusal(request), "");
    }
}

TEST_F(MemoryBudget, OffersTheLargestPictureThatFits) {
    FrameRequest request = described_request();
    request.size = {400, 300};
    Renderer& renderer = test_renderer();
    renderer.set_volume(nullptr);
    renderer.set_volume(request.volume);
    renderer.set_memory_budget(describe_frame(request, renderer).total_bytes() / 2);
    FrameRequest fitting = renderer.fitting_changes(request).front().request;
    EXPECT_LT(fitting.size.x, request.size.x);
    EXPECT_NEAR(fitting.size.x * 3.0, fitting.size.y * 4.0, 8);
    EXPECT_EQ(refusal(fitting), "");
    renderer.set_volume(request.volume);
    fitting.size += 3;
    EXPECT_NE(refusal(fitting), "");
}

}  // namespace
}  // namespace edgesplat::test

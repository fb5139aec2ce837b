// Recorded command buffers: which lists are replayed, and which are let go.
#include <gmock/gmock.h>

#include "engine/error.h"
#include "engine/forecast/memory.h"
#include "engine/gpu/kept_commands.h"
#include "tests/passes/device_under_test.h"

namespace edgesplat::test {
namespace {

using gpu::CommandList;

class KeptCommandsTest : public testing::Test {
  protected:
    const gpu::Device& device_ = device_under_test().device;
    gpu::KeptCommands kept_{device_};
    gpu::Buffer buffer_{device_, 64, gpu::Buffer::Place::Device, "filled"};

    /// `length` commands, the others being barriers.
    CommandList filling(std::uint32_t value, std::size_t length = 1) const {
        CommandList list(length, gpu::command::Barrier());
        list.front() = gpu::command::Fill{buffer_.use(), 0, VK_WHOLE_SIZE, value};
        return list;
    }
    /// Whether it had to be recorded.
    bool records(const CommandList& list) {
        const std::uint64_t before = kept_.recorded();
        EXPECT_TRUE(kept_.of(list));
        return kept_.recorded() > before;
    }
};

TEST_F(KeptCommandsTest, EqualListsAreRecordedOnce) {
    const vk::CommandBuffer first = kept_.of(filling(1));
    EXPECT_NE(kept_.of(filling(2)), first);
    EXPECT_EQ(kept_.of(filling(1)), first);
    EXPECT_EQ(kept_.recorded(), 2U);
    EXPECT_EQ(kept_.replayed(), 1U);
    EXPECT_TRUE(records(filling(1, 2))) << "longer by one";
    kept_.clear();
    EXPECT_TRUE(records(filling(1)));
}

TEST_F(KeptCommandsTest, AHandleThatIsGivenAnewIsAnotherResource) {
    CommandList list = filling(1);
    EXPECT_TRUE(records(list));
    EXPECT_FALSE(records(list));
    std::get<gpu::command::Fill>(list.front()).buffer.serial =
        gpu::Buffer(device_, 16, gpu::Buffer::Place::Host, "next").serial();
    EXPECT_TRUE(records(list));
    const vk::DescriptorSet set = device_under_test().bindings.set().handle();
    const vk::PipelineLayout layout = device_under_test().pipelines.layout();
    for (const std::uint64_t version : {7, 8})
        EXPECT_TRUE(records({gpu::command::BindSet{vk::PipelineBindPoint::eCompute, layout, set, version}}));
}

TEST_F(KeptCommandsTest, WhatWasNotAskedForLongestIsLetGo) {
    for (std::uint32_t i = 0; i < gpu::KeptCommands::kMostLists; ++i)
        EXPECT_TRUE(records(filling(i)));
    EXPECT_FALSE(records(filling(0)));
    EXPECT_TRUE(records(filling(1000))) << "in the place of 1";
    EXPECT_FALSE(records(filling(0)));
    EXPECT_FALSE(records(filling(2)));
    EXPECT_TRUE(records(filling(1)));
}

TEST_F(KeptCommandsTest, LongListsAreKeptAsLongAsThereIsRoom) {
    constexpr std::size_t kHalf = gpu::KeptCommands::kMostCommands / 2;
    EXPECT_TRUE(records(filling(1, kHalf)));
    EXPECT_TRUE(records(filling(2, kHalf)));
    EXPECT_FALSE(records(filling(1, kHalf)));
    EXPECT_TRUE(records(filling(3)));
    EXPECT_FALSE(records(filling(1, kHalf)));
    EXPECT_TRUE(records(filling(2, kHalf)));
    // Even one that is longer than all may be together.
    EXPECT_TRUE(records(filling(4, 3 * kHalf)));
    EXPECT_FALSE(records(filling(4, 3 * kHalf)));
    EXPECT_TRUE(records(filling(2, kHalf)));
}

TEST_F(KeptCommandsTest, WhatListsBringAlongCounts) {
    constexpr std::size_t kWords = gpu::KeptCommands::kMostCommands / 4;
    const gpu::Buffer words(device_, kWords * sizeof(std::uint32_t), gpu::Buffer::Place::Device, "words");
    const auto bringing = [&](std::uint32_t value) -> CommandList {
        return {gpu::command::Update{words.use(), 0, std::vector<std::uint32_t>(kWords, value)}};
    };
    for (std::uint32_t i = 0; i < 3; ++i)
        EXPECT_TRUE(records(bringing(i)));
    EXPECT_FALSE(records(bringing(0)));
    EXPECT_TRUE(records(bringing(3))) << "in the place of 1";
    EXPECT_FALSE(records(bringing(0)));
    EXPECT_TRUE(records(bringing(1)));
}

TEST(Commands, AfterATimeOutWaitForWhatTheDeviceIsStillAt) {
    RendererState& state = device_under_test();
    const gpu::Buffer filled(state.device, std::size_t{1} << 28U, gpu::Buffer::Place::Host, "filled");
    const std::uint64_t before = state.device.validation_messages();
    state.commands.set_timeout(0);
    const auto fill = [&](std::uint32_t value) { state.commands.run([&] { state.commands.fill(filled, value); }); };
    EXPECT_THROW(fill(1), Error);
    state.commands.set_timeout(gpu::Commands::kTimeout);
    fill(2);
    EXPECT_EQ(filled.mapped<std::uint32_t>(1)[0], 2U);
    EXPECT_EQ(state.device.validation_messages(), before);
}

TEST(Devices, AreRefusedForWhatTheShadersNeed) {
    vk::PhysicalDeviceLimits limits = device_under_test().device.physical().getProperties().limits;
    vk::PhysicalDeviceSubgroupProperties subgroups;
    subgroups.supportedStages = vk::ShaderStageFlagBits::eCompute;
    subgroups.supportedOperations = vk::SubgroupFeatureFlagBits::eBasic | vk::SubgroupFeatureFlagBits::eArithmetic |
                                    vk::SubgroupFeatureFlagBits::eBallot;
    EXPECT_TRUE(gpu::beyond_limits(limits, subgroups).empty());
    subgroups.supportedOperations &= ~vk::SubgroupFeatureFlags(vk::SubgroupFeatureFlagBits::eBallot);
    EXPECT_THAT(gpu::beyond_limits(limits, subgroups), testing::ElementsAre(testing::HasSubstr("{ Ballot }")));
    limits.maxPerStageDescriptorStorageImages = 4;
    EXPECT_THAT(gpu::beyond_limits(limits, subgroups),
                testing::ElementsAre("maxPerStageDescriptorStorageImages is 4, 15 are needed", testing::_));
}

TEST(Texels, AreCountedByTheirFormat) {
    const gpu::Device& device = device_under_test().device;
    const std::size_t most = device.physical().getProperties().limits.maxTexelBufferElements;
    for (const auto& [format, bytes] : {std::pair{vk::Format::eR32Uint, std::size_t{4}},
                                        {vk::Format::eR32G32Uint, std::size_t{8}},
                                        {vk::Format::eR32G32B32A32Sfloat, std::size_t{16}}}) {
        EXPECT_EQ(gpu::Buffer::beyond_texels(device, most * bytes, format), "");
        EXPECT_NE(gpu::Buffer::beyond_texels(device, (most + 1) * bytes, format), "");
    }
}

TEST(Texels, ThatAreTooManyDoNotFit) {
    const gpu::Device& device = device_under_test().device;
    FrameForecast forecast;
    PlannedResource& pixels = forecast.resources.emplace_back();
    pixels.name = "pixels";
    pixels.texels = vk::Format::eR32Uint;
    pixels.bytes = (std::size_t{device.physical().getProperties().limits.maxTexelBufferElements} + 1) * 4;
    EXPECT_THAT(memory_need(device, forecast, 0).too_large, testing::Contains(testing::HasSubstr("texels")));
}

}  // namespace
}  // namespace edgesplat::test

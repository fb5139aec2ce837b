// The layer over Vulkan: time-outs, refused devices, limits of texels.
#include <gmock/gmock.h>

#include "engine/error.h"
#include "engine/forecast/memory.h"
#include "tests/passes/device_under_test.h"

namespace edgesplat::test {
namespace {

TEST(Commands, WaitForUnfinishedWorkAfterATimeOut) {
    DeviceUnderTest& state = device_under_test();
    const gpu::Buffer filled(state.device(), std::size_t{1} << 28U, gpu::Buffer::Place::Host, "filled");
    const std::uint64_t before = state.device().validation_messages();
    state.commands().set_timeout(0);
    const auto fill = [&](std::uint32_t value) { state.commands().run([&] { state.commands().fill(filled, value); }); };
    EXPECT_THROW(fill(1), Error);
    state.commands().set_timeout(gpu::Commands::kTimeout);
    fill(2);
    EXPECT_EQ(filled.mapped<std::uint32_t>(1)[0], 2U);
    EXPECT_EQ(state.device().validation_messages(), before);
}

TEST(Buffers, ReportWritesBeyondTheirEnd) {
    const gpu::Device device({.device = device_under_test().device().info().name, .validation = true});
    if (!device.guards_buffers()) GTEST_SKIP() << "not all memory of the device can be mapped: " << device.info().name;
    {
        const gpu::Buffer sound(device, 40, gpu::Buffer::Place::Host, "sound");
        sound.mapped<std::uint32_t>(10)[9] = 1;
        EXPECT_THROW((void)sound.mapped<std::uint32_t>(11), Error);
    }
    EXPECT_EQ(device.validation_messages(), 0U);
    {
        gpu::Buffer written(device, 40, gpu::Buffer::Place::Host, "written");
        written.mapped<std::uint32_t>(10).data()[10] = 1;
        const gpu::Buffer moved = std::move(written);
    }
    EXPECT_EQ(device.validation_messages(), 1U);
}

TEST(DeviceProfiles, CanBeForcedAndStateTheReason) {
    for (const gpu::DeviceProfile& profile : gpu::device_profiles()) {
        EXPECT_EQ(&gpu::profile_named(profile.name), &profile);
        EXPECT_GE(profile.list_group, gpu::device_profiles().front().list_group) << "lists must have room for a group";
        vk::PhysicalDeviceProperties any;
        const gpu::ChosenProfile forced = gpu::choose_profile(any, std::string(profile.name));
        EXPECT_EQ(forced.profile, &profile);
        EXPECT_EQ(forced.reason, "set by --device-profile");
    }
    EXPECT_THROW(gpu::profile_named("fast"), Error);
}

TEST(Devices, AreRefusedIfTheyLackShaderRequirements) {
    vk::PhysicalDeviceLimits limits = device_under_test().device().physical().getProperties().limits;
    vk::PhysicalDeviceSubgroupProperties subgroups;
    subgroups.supportedStages = vk::ShaderStageFlagBits::eCompute;
    subgroups.supportedOperations = vk::SubgroupFeatureFlagBits::eBasic | vk::SubgroupFeatureFlagBits::eArithmetic |
                                    vk::SubgroupFeatureFlagBits::eBallot;
    EXPECT_TRUE(gpu::exceeds_limits(limits, subgroups).empty());
    subgroups.supportedOperations &= ~vk::SubgroupFeatureFlags(vk::SubgroupFeatureFlagBits::eBallot);
    EXPECT_THAT(gpu::exceeds_limits(limits, subgroups), testing::ElementsAre(testing::HasSubstr("{ Ballot }")));
    limits.maxPerStageDescriptorStorageImages = 4;
    EXPECT_THAT(gpu::exceeds_limits(limits, subgroups),
                testing::ElementsAre("maxPerStageDescriptorStorageImages is 4, 17 are needed", testing::_));
}

TEST(Texels, AreCountedByTheirFormat) {
    const gpu::Device& device = device_under_test().device();
    if (!device.loads_texels()) GTEST_SKIP() << "this device loads buffers through their addresses";
    const std::size_t most = device.physical().getProperties().limits.maxTexelBufferElements;
    for (const auto& [format, bytes] : {std::pair{vk::Format::eR32Uint, std::size_t{4}},
                                        {vk::Format::eR32G32Uint, std::size_t{8}},
                                        {vk::Format::eR32G32B32A32Sfloat, std::size_t{16}}}) {
        EXPECT_EQ(gpu::Buffer::texel_limit_error(device, most * bytes, format), "");
        EXPECT_NE(gpu::Buffer::texel_limit_error(device, (most + 1) * bytes, format), "");
    }
}

TEST(Texels, BeyondTheDeviceLimitDoNotFit) {
    const gpu::Device& device = device_under_test().device();
    if (!device.loads_texels()) GTEST_SKIP() << "this device loads buffers through their addresses";
    FrameForecast forecast;
    PlannedResource& pixels = forecast.resources.emplace_back();
    pixels.text.name = "pixels";
    pixels.texels = vk::Format::eR32Uint;
    pixels.bytes = (std::size_t{device.physical().getProperties().limits.maxTexelBufferElements} + 1) * 4;
    EXPECT_THAT(memory_need(device, forecast, 0).too_large, testing::Contains(testing::HasSubstr("texels")));
}

}  // namespace
}  // namespace edgesplat::test

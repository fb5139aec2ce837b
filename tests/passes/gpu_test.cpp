// The layer over Vulkan: runs that take too long, what devices are refused for, limits of texels.
#include <gmock/gmock.h>

#include "engine/error.h"
#include "engine/forecast/memory.h"
#include "tests/passes/device_under_test.h"

namespace edgesplat::test {
namespace {

TEST(Commands, AfterATimeOutWaitForWhatTheDeviceIsStillAt) {
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

TEST(Buffers, SayWhatWasWrittenBehindThem) {
    const gpu::Device device({.device = device_under_test().device().info().name, .validation = true});
    if (!device.guards_buffers()) GTEST_SKIP() << "not all memory of " << device.info().name << " can be mapped";
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

TEST(DeviceProfiles, CanBeForcedAndSayWhy) {
    for (const gpu::DeviceProfile& profile : gpu::device_profiles()) {
        EXPECT_EQ(&gpu::profile_named(profile.name), &profile);
        EXPECT_GE(profile.list_group, gpu::device_profiles().front().list_group) << "lists have room for these";
        vk::PhysicalDeviceProperties any;
        const gpu::ChosenProfile forced = gpu::choose_profile(any, std::string(profile.name));
        EXPECT_EQ(forced.profile, &profile);
        EXPECT_EQ(forced.reason, "asked for by --device-profile");
    }
    EXPECT_THROW(gpu::profile_named("fast"), Error);
}

TEST(Devices, AreRefusedForWhatTheShadersNeed) {
    vk::PhysicalDeviceLimits limits = device_under_test().device().physical().getProperties().limits;
    vk::PhysicalDeviceSubgroupProperties subgroups;
    subgroups.supportedStages = vk::ShaderStageFlagBits::eCompute;
    subgroups.supportedOperations = vk::SubgroupFeatureFlagBits::eBasic | vk::SubgroupFeatureFlagBits::eArithmetic |
                                    vk::SubgroupFeatureFlagBits::eBallot;
    EXPECT_TRUE(gpu::beyond_limits(limits, subgroups).empty());
    subgroups.supportedOperations &= ~vk::SubgroupFeatureFlags(vk::SubgroupFeatureFlagBits::eBallot);
    EXPECT_THAT(gpu::beyond_limits(limits, subgroups), testing::ElementsAre(testing::HasSubstr("{ Ballot }")));
    limits.maxPerStageDescriptorStorageImages = 4;
    EXPECT_THAT(gpu::beyond_limits(limits, subgroups),
                testing::ElementsAre("maxPerStageDescriptorStorageImages is 4, 16 are needed", testing::_));
}

TEST(Texels, AreCountedByTheirFormat) {
    const gpu::Device& device = device_under_test().device();
    if (!device.loads_texels()) GTEST_SKIP() << "buffers are loaded through their addresses here";
    const std::size_t most = device.physical().getProperties().limits.maxTexelBufferElements;
    for (const auto& [format, bytes] : {std::pair{vk::Format::eR32Uint, std::size_t{4}},
                                        {vk::Format::eR32G32Uint, std::size_t{8}},
                                        {vk::Format::eR32G32B32A32Sfloat, std::size_t{16}}}) {
        EXPECT_EQ(gpu::Buffer::beyond_texels(device, most * bytes, format), "");
        EXPECT_NE(gpu::Buffer::beyond_texels(device, (most + 1) * bytes, format), "");
    }
}

TEST(Texels, ThatAreTooManyDoNotFit) {
    const gpu::Device& device = device_under_test().device();
    if (!device.loads_texels()) GTEST_SKIP() << "buffers are loaded through their addresses here";
    FrameForecast forecast;
    PlannedResource& pixels = forecast.resources.emplace_back();
    pixels.text.name = "pixels";
    pixels.texels = vk::Format::eR32Uint;
    pixels.bytes = (std::size_t{device.physical().getProperties().limits.maxTexelBufferElements} + 1) * 4;
    EXPECT_THAT(memory_need(device, forecast, 0).too_large, testing::Contains(testing::HasSubstr("texels")));
}

}  // namespace
}  // namespace edgesplat::test

#include "engine/gpu/device_profile.h"

#include <algorithm>
#include <array>
#include <cstdlib>

#include "engine/error.h"

namespace edgesplat::gpu {
namespace {

// Subgroup sizes: lavapipe 8 invocations, GPUs 32 or 64.
constexpr std::array kProfiles{
    DeviceProfile{.name = "lavapipe",
                  .rounds = true,
                  .list_group = 16,
                  .tile_group = 256,
                  .list_parts = 1,
                  .front_first = true,
                  .side_by_side = false,
                  .tile_blocks = 64,
                  .loops = true,
                  .late_timestamps = true},
    DeviceProfile{.name = "generic", .list_group = 32, .texels = false},
    DeviceProfile{.name = "discrete",
                  .refines = false,
                  .chunk_pairs = 1048576,
                  .tile_pairs = 4096,
                  .list_parts = 32,
                  .own_memory = true},
};

}  // namespace

std::span<const DeviceProfile> device_profiles() {
    return kProfiles;
}

const DeviceProfile& profile_named(std::string_view name) {
    const auto found = std::ranges::find(kProfiles, name, &DeviceProfile::name);
    if (found == kProfiles.end()) fail("device profile `{}`: expected lavapipe, generic or discrete", name);
    return *found;
}

ChosenProfile choose_profile(const vk::PhysicalDeviceProperties& device, const std::string& wanted) {
    if (!wanted.empty()) return {&profile_named(wanted), "set by --device-profile"};
    const char* variable = std::getenv("EDGESPLAT_DEVICE_PROFILE");
    if (variable != nullptr && *variable != '\0') return {&profile_named(variable), "set by EDGESPLAT_DEVICE_PROFILE"};
    if (is_processor(device)) return {&profile_named("lavapipe"), "the device is the processor"};
    if (device.deviceType == vk::PhysicalDeviceType::eDiscreteGpu)
        return {&profile_named("discrete"), "the device is a GPU with its own memory"};
    return {&profile_named("generic"),
            "there is no special profile for device type " + vk::to_string(device.deviceType)};
}

ChosenProfile choose_profile(const std::string& wanted) {
    vk::PhysicalDeviceProperties processor;
    processor.deviceType = vk::PhysicalDeviceType::eCpu;
    return choose_profile(processor, wanted);
}

bool is_processor(const vk::PhysicalDeviceProperties& device) {
    return device.deviceType == vk::PhysicalDeviceType::eCpu;
}

int rank_of(const vk::PhysicalDeviceProperties& device) {
    switch (device.deviceType) {
        case vk::PhysicalDeviceType::eDiscreteGpu:
            return 0;
        case vk::PhysicalDeviceType::eIntegratedGpu:
            return 1;
        case vk::PhysicalDeviceType::eVirtualGpu:
            return 2;
        case vk::PhysicalDeviceType::eCpu:
            return 3;
        default:
            return kWorstRank;
    }
}

}  // namespace edgesplat::gpu

#include "apps/device_options.h"

#include <fmt/format.h>

namespace {

void print_devices() {
    const std::vector<edgesplat::DeviceInfo> devices = edgesplat::list_devices();
    if (devices.empty())
        fmt::print("no Vulkan device; the package mesa-vulkan-drivers provides one that runs on the processor\n");
    for (const edgesplat::DeviceInfo& d : devices) {
        fmt::print("{}: {} ({}), {} {}, Vulkan {}, profile {}\n", d.index, d.name, d.type, d.driver, d.driver_version,
                   d.api_version, d.profile);
        for (const std::string& reason : d.rejections)
            fmt::print("   cannot be used: {}\n", reason);
    }
}

}  // namespace

void add_device_list(CLI::App& app) {
    app.add_flag_callback(
           "--list-devices",
           [] {
               print_devices();
               throw CLI::Success();
           },
           "Print the Vulkan devices and exit")
        ->group("Device");
}

void add_device_options(CLI::App& command, edgesplat::DeviceChoice& choice) {
    constexpr const char* kGroup = "Device";
    command.add_option("--device", choice.device, "Vulkan device: its number in --list-devices or a part of its name")
        ->type_name("DEVICE")
        ->group(kGroup);
    command
        .add_option("--device-profile", choice.profile,
                    "Use this device profile (lavapipe, generic or discrete) instead of the one for the device; "
                    "--explain prints the profile in use")
        ->type_name("PROFILE")
        ->group(kGroup);
    add_device_list(command);
    command
        .add_flag("--keep-splats", choice.keep_splats,
                  "Keep found surfaces on disk, and use those of earlier runs with the same samples, iso-values and "
                  "settings: the picture is the same and appears sooner. At most 4 GiB in ~/.cache/edgesplat/splats "
                  "(EDGESPLAT_CACHE)")
        ->group(kGroup);
    command.add_flag("--validation", choice.validation, "Check every Vulkan call; any message makes the program fail")
        ->group(kGroup);
    command
        .add_flag("--check-numbers", choice.check_numbers,
                  "Check all results for numbers that are not finite; fail and name the first pass and splat that "
                  "produce one")
        ->group(kGroup);
}

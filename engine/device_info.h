// Which devices there are, which one to open, and what a device says of its work.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace edgesplat {

/// One Vulkan device of this machine, usable or not.
struct DeviceInfo {
    int index = 0;
    std::string name, type, driver, driver_version, api_version;
    std::vector<std::string> rejections;  ///< why it cannot be used; empty = usable
    bool is_processor = false;            ///< it is the processor itself: its time is the processor's
    std::string profile, profile_reason;  ///< how frames are made on it, and why so (gpu/device_profile.h)
};

/// Which device to open and how loudly to check it.
struct DeviceChoice {
    std::string device;       ///< empty: the best usable one; else an index or a part of a name
    bool validation = false;  ///< Khronos validation and synchronization validation; messages are counted
    /// Pictures are looked through for numbers that are not finite: render() then throws Error, naming the first pass
    /// and splat that came to one. For finding faults; without it nothing is read back or run for it.
    bool check_numbers = false;
    std::string profile;  ///< how frames are made, a name in gpu/device_profile.h; empty: as the device is
};

/// Every device of this machine, best first. Empty where there is no Vulkan loader or driver.
std::vector<DeviceInfo> list_devices();

struct PassTime {
    std::string name;  ///< stem of the pass, e.g. "5_draw_splats"
    double milliseconds = 0;
};

/// What drawing the splats of a picture came to.
struct DrawCounts {
    std::uint64_t vertices = 0;   ///< invocations of the vertex shader
    std::uint64_t fragments = 0;  ///< of the fragment shader, as the driver counts them: some before the depth test
    std::uint64_t shaded = 0;     ///< samples that passed the depth test
};

}  // namespace edgesplat

// The Vulkan devices of this machine, the choice of one, and its timings and draw counts.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace edgesplat {

/// One Vulkan device of this machine, usable or not.
struct DeviceInfo {
    int index = 0;
    std::string name, type, driver, driver_version, api_version;
    std::vector<std::string> rejections;  ///< reasons why the device cannot be used; empty: usable
    bool is_processor = false;            ///< a software device that runs on the processor
    /// name of its profile (gpu/device_profile.h) and the reason for that profile
    std::string profile, profile_reason;
};

/// The device to open and the checks that it runs.
struct DeviceChoice {
    std::string device;       ///< an index or part of a name; empty: the best usable device
    bool validation = false;  ///< enables Khronos validation and synchronization validation; messages are counted
    /// Searches every picture for non-finite numbers. render() then throws Error that names the first pass and splat
    /// that produced one. For debugging; when false, nothing is run or read back for this check.
    bool check_numbers = false;
    /// Keeps found surfaces in the folder of files between runs, and uses those of earlier runs.
    bool keep_splats = false;
    std::string profile;  ///< name of a profile in gpu/device_profile.h; empty: the device's own profile
};

/// All Vulkan devices of this machine, best first. Empty without a Vulkan loader or driver.
std::vector<DeviceInfo> list_devices();

struct PassTime {
    std::string name;  ///< stem of the pass, e.g. "5_draw_splats"
    double milliseconds = 0;
};

/// Pipeline statistics of the draws of a picture's splats.
struct DrawCounts {
    std::uint64_t vertices = 0;  ///< vertex shader invocations
    /// fragment shader invocations as the driver counts them; some are counted before the depth test
    std::uint64_t fragments = 0;
    std::uint64_t shaded = 0;  ///< samples that passed the depth test
};

}  // namespace edgesplat

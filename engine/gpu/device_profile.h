// What is known of drivers and devices, and what follows from it for a frame. The one place that knows: all else asks
// here what to do, never which device it is.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vulkan/vulkan_raii.hpp>

namespace edgesplat::gpu {

/// How a frame is made on a kind of device. Pictures are the same with each but for rounding.
struct DeviceProfile {
    std::string_view name;
    /// Lists of tiles are drawn so many entries at a time, and the host looks at them in between: where a driver ends
    /// all loops of an invocation together after 65535 iterations (shaders/shared/limits.h).
    bool rounds = false;
    /// Whether pixels between those that are drawn may follow from these (PixelChoice::Refined): where there are more
    /// invocations at work than pixels, what waits for another step takes longer than it spares.
    bool refines = true;
    /// Invocations of a workgroup for lists of pixels, which are of very different length: about a subgroup.
    std::uint32_t list_group = 64;
    /// And for all pixels of a tile.
    std::uint32_t tile_group = 128;
    /// Pairs of a splat and a tile that a chunk of sheets may have, and for each tile. Small chunks close tiles early
    /// for those behind; each costs some dispatches.
    std::uint64_t chunk_pairs = 262144, tile_pairs = 256;
    /// Parts into which a tile's list is divided among the invocations that mark pixels; 1: none.
    std::uint32_t list_parts = 8;
    /// A frame is drawn in two parts where what is in front may hide bricks behind it. Waiting in between takes longer
    /// than it spares where the device is not the processor itself.
    bool front_first = false;
    /// Pairs of splats and what they are sorted to find their places side by side, each by looking at those before it;
    /// else one after another, in columns.
    bool side_by_side = true;
    /// Columns of the tiles' histogram: of few, each has a share of a chunk for one invocation; of many, for a
    /// workgroup.
    std::uint32_t tile_blocks = 512;
    /// What both host and device use lies in the device's own memory, and is copied: each read of the host's would be
    /// waited for.
    bool own_memory = false;
    /// What few invocations need is entered by a loop, not by an if, whose sides a driver may run for all of them.
    bool loops = false;
    /// Buffers are loaded as texels, not through their addresses, where the device has texels enough.
    bool texels = true;
    /// Timestamps are written when the device next rasterises, which may be after what was recorded later: barriers
    /// around them.
    bool late_timestamps = false;
};

/// "lavapipe": devices that are the processor; "generic": what runs everywhere else; "discrete": GPUs with memory of
/// their own. The first is that of forecasts without a device; no list_group is smaller than its own.
std::span<const DeviceProfile> device_profiles();

/// Throws Error listing the names.
const DeviceProfile& profile_named(std::string_view name);

/// A device's profile and why it has it.
struct ChosenProfile {
    const DeviceProfile* profile;
    std::string reason;
};

/// `wanted`: a name, which may be any device's; empty: what the environment variable EDGESPLAT_DEVICE_PROFILE says,
/// else what the device is.
ChosenProfile choose_profile(const vk::PhysicalDeviceProperties& device, const std::string& wanted);
/// The same of no device: else what the processor is.
ChosenProfile choose_profile(const std::string& wanted);

/// Whether the device is the processor itself, whatever its profile.
bool is_processor(const vk::PhysicalDeviceProperties& device);

/// Devices in the order in which one is looked for: the lower the better, up to kWorstRank.
int rank_of(const vk::PhysicalDeviceProperties& device);
inline constexpr int kWorstRank = 4;

}  // namespace edgesplat::gpu

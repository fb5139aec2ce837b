// Device profiles: how a frame is drawn on each kind of device. Only this file knows drivers; all other code reads a
// profile and never tests which device it has.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vulkan/vulkan_raii.hpp>

namespace edgesplat::gpu {

/// How a frame is drawn on one kind of device. Pictures differ between profiles by rounding only.
struct DeviceProfile {
    std::string_view name;
    /// Tile lists are drawn in rounds of a fixed number of entries; the host reads the lists between rounds. Needed if
    /// a driver ends all loops of an invocation after 65535 iterations in total (shaders/shared/limits.h).
    bool rounds = false;
    /// Whether pixels may be interpolated between drawn ones (PixelChoice::Refined). If the device runs more
    /// invocations than the picture has pixels, waiting for a further step costs more than it saves.
    bool refines = true;
    /// Invocations of a workgroup for lists of pixels: about a subgroup, since list lengths differ widely.
    std::uint32_t list_group = 64;
    /// Invocations of a workgroup for all pixels of a tile.
    std::uint32_t tile_group = 128;
    /// Limits of a chunk of sheets: (splat, tile) pairs in total, and per tile. With small chunks tiles saturate before
    /// the chunks behind are drawn; each chunk costs some dispatches.
    std::uint64_t chunk_pairs = 262144, tile_pairs = 256;
    /// Parts into which a tile's list is divided among the invocations that mark pixels; 1: not divided.
    std::uint32_t list_parts = 8;
    /// Draws a frame in two parts if the front part may occlude bricks behind it. Only on software devices: elsewhere
    /// waiting between the parts costs more than it saves.
    bool front_first = false;
    /// Sorts run in parallel over (splat, sheet) and (splat, tile) pairs: each finds its rank among the pairs before
    /// it. Otherwise each invocation processes the pairs of a column in order.
    bool side_by_side = true;
    /// Columns of the tiles' histogram. With few columns one invocation processes a column; with many, a workgroup.
    std::uint32_t tile_blocks = 512;
    /// Buffers that host and device share lie in device memory and are copied, since reads from host memory are slow.
    bool own_memory = false;
    /// Rare branches are one-iteration loops instead of `if`, since a driver may run both sides of an `if` for all
    /// invocations.
    bool loops = false;
    /// Buffers are loaded as texels, not through their addresses, if the device allows large enough texel buffers.
    bool texels = true;
    /// The device may write a timestamp after commands that were recorded later (when it next rasterises), so
    /// timestamps have barriers around them.
    bool late_timestamps = false;
};

/// "lavapipe": software devices, on the processor. "discrete": GPUs with their own memory. "generic": all others.
/// Forecasts without a device use "lavapipe"; it has the smallest list_group.
std::span<const DeviceProfile> device_profiles();

/// Throws Error listing the names.
const DeviceProfile& profile_named(std::string_view name);

/// A device's profile and the reason for the choice.
struct ChosenProfile {
    const DeviceProfile* profile;
    std::string reason;
};

/// `wanted`: a profile's name, valid for any device. Empty: the environment variable EDGESPLAT_DEVICE_PROFILE, else by
/// the device's type.
ChosenProfile choose_profile(const vk::PhysicalDeviceProperties& device, const std::string& wanted);
/// The same without a device: a software device is assumed.
ChosenProfile choose_profile(const std::string& wanted);

/// Whether the device is the processor itself, independent of its profile.
bool is_processor(const vk::PhysicalDeviceProperties& device);

/// Rank in the choice of a device: 0 (preferred) to kWorstRank.
int rank_of(const vk::PhysicalDeviceProperties& device);
inline constexpr int kWorstRank = 4;

}  // namespace edgesplat::gpu

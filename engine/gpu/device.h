// The Vulkan instance and device: chooses a device (with reasons), allocates memory, counts validation messages.
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>
#include <vulkan/vulkan_raii.hpp>

#include "engine/device_info.h"
#include "engine/gpu/device_profile.h"

namespace edgesplat::gpu {

/// Counts and prints validation messages. Its address is fixed, since the driver keeps a pointer to it.
struct ValidationLog {
    void add(const char* severity, const char* message);
    std::atomic<std::uint64_t> messages{0};
};

/// Device memory allocated under one name, by buffers and images.
struct Allocation {
    std::uint64_t bytes = 0;  ///< allocated now
    std::uint64_t peak = 0;   ///< maximum since Device::forget_peaks
};

/// A Vulkan 1.3 instance; with `validation`, the Khronos layer and synchronization validation are enabled.
/// Throws Error that names the package to install if the driver or the layer is missing.
vk::raii::Instance create_instance(const vk::raii::Context& context, bool validation, ValidationLog* log,
                                   std::vector<const char*> extensions = {});

/// Extensions that a window needs. Rendering needs none.
struct DeviceExtensions {
    std::vector<const char*> instance, device;
};

/// Description of a physical device and every reason it cannot be used (empty: it can). `profile`: as in DeviceChoice.
DeviceInfo describe(const vk::raii::PhysicalDevice& physical, int index, const std::string& profile);

/// One reason for each limit below what the descriptor set and the shaders need.
std::vector<std::string> exceeds_limits(const vk::PhysicalDeviceLimits& limits,
                                        const vk::PhysicalDeviceSubgroupProperties& subgroups);

/// An opened device with one queue for graphics, compute and transfer.
class Device {
  public:
    explicit Device(const DeviceChoice& choice, const DeviceExtensions& extensions = {});

    const DeviceInfo& info() const { return info_; }
    const vk::raii::Instance& instance() const { return instance_; }
    const vk::raii::Device& handle() const { return device_; }
    const vk::raii::PhysicalDevice& physical() const { return physical_; }
    const vk::raii::Queue& queue() const { return queue_; }
    std::uint32_t queue_family() const { return queue_family_; }
    /// Nanoseconds per timestamp tick; 0 if the queue has no timestamps.
    double timestamp_period() const { return timestamp_period_; }
    const DeviceProfile& profile() const { return *profile_; }
    /// Whether shaders load buffers as texels (DeviceProfile::texels) and the device allows texel buffers large enough.
    bool loads_texels() const { return loads_texels_; }
    /// Whether draws can be counted: pipeline statistics and precise occlusion queries.
    bool counts_draws() const { return counts_draws_; }
    /// Why the device cannot draw into layers of a target; empty if it can.
    const std::string& layers_obstacle() const { return layers_obstacle_; }
    std::uint64_t validation_messages() const { return log_->messages; }
    /// Whether buffers end in guard bytes (see Buffer): validation is on and all memory types can be mapped.
    bool guards_buffers() const { return guards_buffers_; }
    /// Prints and counts the message like a validation error.
    void report(const std::string& message) const;
    /// Bytes of device memory that buffers and images occupy now.
    std::uint64_t allocated_bytes() const { return allocations_->at(kTotal).bytes; }
    /// Maximum of allocated_bytes() since forget_peaks.
    std::uint64_t peak_bytes() const { return allocations_->at(kTotal).peak; }
    /// Allocations by the name of the buffer or image; the empty name has the total.
    const std::map<std::string, Allocation>& allocations() const { return *allocations_; }
    /// Resets each peak to the present allocation and removes names without an allocation.
    void forget_peaks() const;

    /// The memory heap of host-mapped buffers (`host`), or of images and all other buffers.
    std::uint32_t heap_of(bool host) const;
    /// Free bytes of a heap: as the driver reports (VK_EXT_memory_budget), else heap size minus allocated_bytes().
    std::uint64_t free_bytes(std::uint32_t heap) const;
    /// Maximum size of one allocation, bytes.
    std::uint64_t largest_allocation() const;

    /// Allocates memory of the first type that has `wanted` and `needed`, else `needed` alone.
    /// Throws Error with the sizes if that fails.
    vk::raii::DeviceMemory allocate(const vk::MemoryRequirements& requirements, vk::MemoryPropertyFlags wanted,
                                    vk::MemoryPropertyFlags needed, bool device_address, const char* name) const;
    void count_bytes(const std::string& name, std::int64_t change) const;

  private:
    std::optional<std::uint32_t> memory_type(std::uint32_t allowed, vk::MemoryPropertyFlags wanted,
                                             vk::MemoryPropertyFlags needed) const;
    std::unique_ptr<ValidationLog> log_ = std::make_unique<ValidationLog>();
    static constexpr const char* kTotal = "";
    // A fixed address: buffers and images keep using it after the device is moved.
    std::unique_ptr<std::map<std::string, Allocation>> allocations_ =
        std::make_unique<std::map<std::string, Allocation>>(std::map<std::string, Allocation>{{kTotal, {}}});
    vk::raii::Context context_;
    vk::raii::Instance instance_ = nullptr;
    vk::raii::DebugUtilsMessengerEXT messenger_ = nullptr;
    vk::raii::PhysicalDevice physical_ = nullptr;
    vk::raii::Device device_ = nullptr;
    vk::raii::Queue queue_ = nullptr;
    vk::PhysicalDeviceMemoryProperties memory_;
    DeviceInfo info_;
    std::string layers_obstacle_;
    std::uint32_t queue_family_ = 0;
    double timestamp_period_ = 0;
    const DeviceProfile* profile_ = nullptr;
    bool has_memory_budget_ = false, counts_draws_ = false, loads_texels_ = true, guards_buffers_ = false;
};

}  // namespace edgesplat::gpu

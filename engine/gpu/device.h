// The Vulkan instance and device: choice with reasons, queue, memory types, validation messages counted.
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

/// What validation said so far. Lives at a fixed address, since the driver keeps a pointer to it.
struct ValidationLog {
    void add(const char* severity, const char* message);
    std::atomic<std::uint64_t> messages{0};
};

/// Device memory held under one name, by buffers and images.
struct Allocation {
    std::uint64_t bytes = 0;  ///< held now
    std::uint64_t peak = 0;   ///< most that was held since Device::forget_peaks
};

/// An instance of Vulkan 1.3, with the Khronos validation layer and synchronization validation on request.
/// Throws Error that says what to install where there is no loader, no driver, or no such layer.
vk::raii::Instance create_instance(const vk::raii::Context& context, bool validation, ValidationLog* log,
                                   std::vector<const char*> extensions = {});

/// Extensions that a window needs; pictures need none.
struct DeviceExtensions {
    std::vector<const char*> instance, device;
};

/// Description of a physical device and every reason it cannot be used (empty: it can). `profile`: as in DeviceChoice.
DeviceInfo describe(const vk::raii::PhysicalDevice& physical, int index, const std::string& profile);

/// What of these limits is less than the one descriptor set and the shaders need, a reason each.
std::vector<std::string> beyond_limits(const vk::PhysicalDeviceLimits& limits,
                                       const vk::PhysicalDeviceSubgroupProperties& subgroups);

/// An opened device with one queue that does graphics, compute and transfer.
class Device {
  public:
    explicit Device(const DeviceChoice& choice, const DeviceExtensions& extensions = {});

    const DeviceInfo& info() const { return info_; }
    const vk::raii::Instance& instance() const { return instance_; }
    const vk::raii::Device& handle() const { return device_; }
    const vk::raii::PhysicalDevice& physical() const { return physical_; }
    const vk::raii::Queue& queue() const { return queue_; }
    std::uint32_t queue_family() const { return queue_family_; }
    /// Nanoseconds per timestamp tick; 0 where the queue has no timestamps.
    double timestamp_period() const { return timestamp_period_; }
    const DeviceProfile& profile() const { return *profile_; }
    /// Whether shaders load buffers as texels (DeviceProfile::texels): a picture has a texel a pixel, and lists more.
    bool loads_texels() const { return loads_texels_; }
    /// Whether draws can be counted: pipeline statistics and precise occlusion queries.
    bool counts_draws() const { return counts_draws_; }
    /// Why it cannot draw into layers of a target; empty: it can.
    const std::string& layers_obstacle() const { return layers_obstacle_; }
    std::uint64_t validation_messages() const { return log_->messages; }
    /// Whether calls are checked and all memory can be mapped: then buffers have a guard behind them (Buffer).
    bool guards_buffers() const { return guards_buffers_; }
    /// Prints it as validation prints its errors, and counts it among them.
    void report(const std::string& message) const;
    /// Bytes of device memory held now by buffers and images.
    std::uint64_t allocated_bytes() const { return allocations_->at(kTotal).bytes; }
    /// The most that was held at once since forget_peaks.
    std::uint64_t peak_bytes() const { return allocations_->at(kTotal).peak; }
    /// By the name that buffers and images were made with; the empty name holds the total.
    const std::map<std::string, Allocation>& allocations() const { return *allocations_; }
    /// From now on peaks count anew, and names that hold nothing are gone.
    void forget_peaks() const;

    /// The memory heap that buffers mapped by the host come from, or those that are not and images.
    std::uint32_t heap_of(bool host) const;
    /// What can still be allocated from a heap: what the driver says (VK_EXT_memory_budget), else the heap's size less
    /// what is held here.
    std::uint64_t free_bytes(std::uint32_t heap) const;
    /// The most that one allocation may take.
    std::uint64_t largest_allocation() const;

    /// Memory for `requirements` of the first type that has all of `wanted`, else all of `needed`.
    /// Throws Error with the numbers when it is not to be had.
    vk::raii::DeviceMemory allocate(const vk::MemoryRequirements& requirements, vk::MemoryPropertyFlags wanted,
                                    vk::MemoryPropertyFlags needed, bool device_address, const char* name) const;
    void count_bytes(const std::string& name, std::int64_t change) const;

  private:
    std::optional<std::uint32_t> memory_type(std::uint32_t allowed, vk::MemoryPropertyFlags wanted,
                                             vk::MemoryPropertyFlags needed) const;
    std::unique_ptr<ValidationLog> log_ = std::make_unique<ValidationLog>();
    static constexpr const char* kTotal = "";
    // At a fixed address, since buffers and images outlive moves of the device.
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

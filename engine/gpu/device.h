// The Vulkan instance and device: choice with reasons, queue, memory types, validation messages counted.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>
#include <vulkan/vulkan_raii.hpp>

#include "engine/renderer.h"

namespace edgesplat::gpu {

/// What validation said so far. Lives at a fixed address, since the driver keeps a pointer to it.
struct ValidationLog {
    std::atomic<std::uint64_t> messages{0};
};

/// An instance of Vulkan 1.3, with the Khronos validation layer and synchronization validation on request.
/// Throws Error that says what to install where there is no loader, no driver, or no such layer.
vk::raii::Instance create_instance(const vk::raii::Context& context, bool validation, ValidationLog* log);

/// Description of a physical device and every reason it cannot be used (empty: it can).
DeviceInfo describe(const vk::raii::PhysicalDevice& physical, int index);

/// An opened device with one queue that does graphics, compute and transfer.
class Device {
  public:
    explicit Device(const DeviceChoice& choice);

    const DeviceInfo& info() const { return info_; }
    const vk::raii::Device& handle() const { return device_; }
    const vk::raii::PhysicalDevice& physical() const { return physical_; }
    const vk::raii::Queue& queue() const { return queue_; }
    std::uint32_t queue_family() const { return queue_family_; }
    /// Nanoseconds per timestamp tick; 0 where the queue has no timestamps.
    double timestamp_period() const { return timestamp_period_; }
    bool is_software() const { return software_; }
    std::uint64_t validation_messages() const { return log_->messages; }
    /// Bytes of device memory held now by buffers and images.
    std::uint64_t allocated_bytes() const { return *allocated_; }

    /// Memory for `requirements` of the first type that has all of `wanted`, else all of `needed`.
    /// Throws Error with the numbers when it is not to be had.
    vk::raii::DeviceMemory allocate(const vk::MemoryRequirements& requirements, vk::MemoryPropertyFlags wanted,
                                    vk::MemoryPropertyFlags needed, bool device_address, const char* name) const;
    void count_bytes(std::int64_t change) const { *allocated_ += static_cast<std::uint64_t>(change); }

  private:
    std::unique_ptr<ValidationLog> log_ = std::make_unique<ValidationLog>();
    std::unique_ptr<std::uint64_t> allocated_ = std::make_unique<std::uint64_t>(0);
    vk::raii::Context context_;
    vk::raii::Instance instance_ = nullptr;
    vk::raii::DebugUtilsMessengerEXT messenger_ = nullptr;
    vk::raii::PhysicalDevice physical_ = nullptr;
    vk::raii::Device device_ = nullptr;
    vk::raii::Queue queue_ = nullptr;
    vk::PhysicalDeviceMemoryProperties memory_;
    DeviceInfo info_;
    std::uint32_t queue_family_ = 0;
    double timestamp_period_ = 0;
    bool software_ = false;
};

}  // namespace edgesplat::gpu

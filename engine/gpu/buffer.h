// A buffer with its own memory and a device address. Move-only. Shaders write through addresses, which validation does
// not follow: while calls are checked, what stands behind a buffer is looked at when the buffer goes.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vulkan/vulkan_raii.hpp>

#include "engine/gpu/device.h"
#include "shaders/shared/glue.h"

namespace edgesplat::gpu {

class Buffer {
  public:
    /// Host: mapped, coherent, for what the CPU writes or reads. Shared: likewise, but what the device sees may lie in
    /// memory of its own (DeviceProfile::own_memory); then Commands::to_device and to_host bring it over.
    /// Copy: what the host has of such a buffer then, not counted among what the device has allocated.
    enum class Place { Device, Host, Shared, Copy };

    Buffer() = default;
    /// `bytes` > 0 (0 becomes 16, so that an empty list still has an address). With `texels` it can be bound as texels
    /// of that format; throws Error when it has more than the device allows.
    Buffer(const Device& device, std::size_t bytes, Place place, const char* name,
           vk::Format texels = vk::Format::eUndefined);
    ~Buffer() { release(); }
    Buffer(Buffer&& other) noexcept { *this = std::move(other); }
    Buffer& operator=(Buffer&& other) noexcept;
    Buffer(const Buffer&) = delete;
    Buffer& operator=(const Buffer&) = delete;

    /// What a buffer of that size takes of the device's memory.
    static std::uint64_t required_bytes(const Device& device, std::size_t bytes);
    /// How a buffer of texels is beyond what views of the device hold; empty: it is not.
    static std::string beyond_texels(const Device& device, std::size_t bytes, vk::Format texels);

    vk::Buffer handle() const { return *buffer_; }
    std::size_t bytes() const { return bytes_; }
    /// Of the byte `offset`.
    shader::Address address(std::uint64_t offset = 0) const { return address_ + offset; }
    /// Null where it has none.
    vk::BufferView texels() const { return *texels_; }
    explicit operator bool() const { return device_ != nullptr; }

    /// What the host sees of it where that lies apart, else null.
    const Buffer* of_host() const { return of_host_.get(); }
    /// The mapped memory (not of Place::Device) as `count` elements. Throws Error when there are not so many.
    template <typename T>
    std::span<T> mapped(std::size_t count) const {
        if (count > bytes_ / sizeof(T)) too_small(count, sizeof(T));
        return {static_cast<T*>(of_host_ ? of_host_->map_ : map_), count};
    }

  private:
    void release() noexcept;
    void check_guard() const;
    [[noreturn]] void too_small(std::size_t count, std::size_t of_bytes) const;
    const Device* device_ = nullptr;
    std::unique_ptr<Buffer> of_host_;
    vk::raii::DeviceMemory memory_ = nullptr;
    vk::raii::Buffer buffer_ = nullptr;
    vk::raii::BufferView texels_ = nullptr;
    std::string name_;
    std::size_t bytes_ = 0, allocated_ = 0;
    void* map_ = nullptr;
    unsigned char* guard_ = nullptr;  ///< the first byte behind it, where buffers are guarded
    std::uint64_t address_ = 0;
};

}  // namespace edgesplat::gpu

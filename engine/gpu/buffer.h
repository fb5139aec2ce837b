// A buffer with its own memory and a device address. Move-only. Validation cannot check shader writes through
// addresses; with validation on, guard bytes behind the buffer are checked when it is freed.
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
    /// Host: mapped and coherent, read or written by the CPU. Shared: mapped, too, but the device may have its own copy
    /// (DeviceProfile::own_memory); then Commands::to_device and to_host copy between the two.
    /// Copy: the host's side of a Shared buffer, not counted in Device::allocated_bytes().
    enum class Place { Device, Host, Shared, Copy };

    Buffer() = default;
    /// Less than 16 `bytes` become 16, so that an empty list has an address. With `texels` the buffer can be bound as
    /// texels of that format; throws Error if the device does not allow as many.
    Buffer(const Device& device, std::size_t bytes, Place place, const char* name,
           vk::Format texels = vk::Format::eUndefined);
    ~Buffer() { release(); }
    Buffer(Buffer&& other) noexcept { *this = std::move(other); }
    Buffer& operator=(Buffer&& other) noexcept;
    Buffer(const Buffer&) = delete;
    Buffer& operator=(const Buffer&) = delete;

    /// Device memory of a buffer of that size, bytes.
    static std::uint64_t required_bytes(const Device& device, std::size_t bytes);
    /// Error text if the buffer has more texels than the device allows, else empty.
    static std::string texel_limit_error(const Device& device, std::size_t bytes, vk::Format texels);

    vk::Buffer handle() const { return *buffer_; }
    std::size_t bytes() const { return bytes_; }
    /// Device address of the byte `offset`.
    shader::Address address(std::uint64_t offset = 0) const { return address_ + offset; }
    /// The view as texels; null if there is none.
    vk::BufferView texels() const { return *texels_; }
    explicit operator bool() const { return device_ != nullptr; }

    /// The host's copy of a Shared buffer; null if host and device use the same memory.
    const Buffer* host_copy() const { return host_copy_.get(); }
    /// The mapped memory as `count` elements (not for Place::Device). Throws Error if the buffer has fewer.
    template <typename T>
    std::span<T> mapped(std::size_t count) const {
        if (count > bytes_ / sizeof(T)) too_small(count, sizeof(T));
        return {static_cast<T*>(host_copy_ ? host_copy_->map_ : map_), count};
    }

  private:
    void release() noexcept;
    void check_guard() const;
    [[noreturn]] void too_small(std::size_t count, std::size_t of_bytes) const;
    const Device* device_ = nullptr;
    std::unique_ptr<Buffer> host_copy_;
    vk::raii::DeviceMemory memory_ = nullptr;
    vk::raii::Buffer buffer_ = nullptr;
    vk::raii::BufferView texels_ = nullptr;
    std::string name_;
    std::size_t bytes_ = 0, allocated_ = 0;
    void* map_ = nullptr;
    unsigned char* guard_ = nullptr;  ///< the first byte behind the buffer's end; null without guard bytes
    std::uint64_t address_ = 0;
};

}  // namespace edgesplat::gpu

#include "engine/gpu/buffer.h"

#include <algorithm>
#include <utility>
#include <vulkan/vulkan_format_traits.hpp>

#include "engine/error.h"

namespace edgesplat::gpu {

namespace {

constexpr std::size_t kGuardBytes = 4096;
constexpr unsigned char kGuard = 0xa5;

vk::BufferCreateInfo create_info(std::size_t bytes) {
    using Usage = vk::BufferUsageFlagBits;
    return {{},
            std::max<std::size_t>(bytes, 16),
            Usage::eStorageBuffer | Usage::eShaderDeviceAddress | Usage::eIndirectBuffer | Usage::eIndexBuffer |
                Usage::eUniformBuffer | Usage::eStorageTexelBuffer | Usage::eTransferSrc | Usage::eTransferDst};
}

}  // namespace

std::uint64_t Buffer::required_bytes(const Device& device, std::size_t bytes) {
    const vk::BufferCreateInfo info = create_info(bytes);
    return device.handle()
        .getBufferMemoryRequirements(vk::DeviceBufferMemoryRequirements(&info))
        .memoryRequirements.size;
}

std::string Buffer::texel_limit_error(const Device& device, std::size_t bytes, vk::Format texels) {
    const std::uint64_t most = device.physical().getProperties().limits.maxTexelBufferElements;
    const std::uint64_t count = bytes / vk::blockSize(texels);
    return device.loads_texels() && count > most
               ? fmt::format("{} texels; {} allows {}", count, device.info().name, most)
               : "";
}

Buffer::Buffer(const Device& device, std::size_t bytes, Place place, const char* name, vk::Format texels)
    : device_(&device),
      buffer_(device.handle(), create_info(bytes)),
      name_(name),
      bytes_(std::max<std::size_t>(bytes, 16)) {
    using Memory = vk::MemoryPropertyFlagBits;
    if (place == Place::Shared) {
        place = device.profile().own_memory ? Place::Device : Place::Host;
        if (place == Place::Device) host_copy_ = std::make_unique<Buffer>(device, bytes, Place::Copy, name);
    }
    auto requirements = buffer_.getMemoryRequirements();
    allocated_ = place == Place::Copy ? 0 : requirements.size;
    const bool guarded = device.guards_buffers();
    if (guarded) requirements.size += kGuardBytes;
    memory_ = place != Place::Device ? device.allocate(requirements, Memory::eHostCached,
                                                       Memory::eHostVisible | Memory::eHostCoherent, true, name)
                                     : device.allocate(requirements, Memory::eDeviceLocal, {}, true, name);
    buffer_.bindMemory(*memory_, 0);
    void* const map = place != Place::Device || guarded ? memory_.mapMemory(0, VK_WHOLE_SIZE) : nullptr;
    if (place != Place::Device) map_ = map;
    if (guarded) {
        guard_ = static_cast<unsigned char*>(map) + bytes_;
        std::fill_n(guard_, kGuardBytes, kGuard);
    }
    address_ = device.handle().getBufferAddress({*buffer_});
    // If buffers are not loaded as texels, only placeholders have a view.
    constexpr std::size_t kPlaceholderBytes = 16;
    if (texels != vk::Format::eUndefined && (device.loads_texels() || bytes_ <= kPlaceholderBytes)) {
        const std::string beyond = texel_limit_error(device, bytes_, texels);
        if (!beyond.empty()) fail("{}: {}", name_, beyond);
        texels_ = vk::raii::BufferView(device.handle(), {{}, *buffer_, texels, 0, VK_WHOLE_SIZE});
    }
    if (allocated_ > 0) device.count_bytes(name_, static_cast<std::int64_t>(allocated_));
}

Buffer& Buffer::operator=(Buffer&& other) noexcept {
    if (this == &other) return *this;
    release();
    device_ = std::exchange(other.device_, nullptr);
    host_copy_ = std::move(other.host_copy_);
    memory_ = std::move(other.memory_);
    buffer_ = std::move(other.buffer_);
    texels_ = std::move(other.texels_);
    name_ = std::move(other.name_);
    bytes_ = std::exchange(other.bytes_, 0);
    allocated_ = std::exchange(other.allocated_, 0);
    map_ = std::exchange(other.map_, nullptr);
    guard_ = std::exchange(other.guard_, nullptr);
    address_ = std::exchange(other.address_, 0);
    return *this;
}

void Buffer::check_guard() const {
    if (guard_ == nullptr) return;
    const std::span<const unsigned char> guard(guard_, kGuardBytes);
    const auto written = std::ranges::find_if(guard, [](unsigned char byte) { return byte != kGuard; });
    if (written != guard.end())
        device_->report(fmt::format("{}: a shader wrote {} bytes behind the buffer's end; it has {} bytes", name_,
                                    written - guard.begin(), bytes_));
}

void Buffer::too_small(std::size_t count, std::size_t of_bytes) const {
    fail("{}: the buffer has {} bytes, but {} elements of {} bytes were requested", name_, bytes_, count, of_bytes);
}

void Buffer::release() noexcept {
    if (device_ == nullptr) return;
    check_guard();
    if (allocated_ > 0) device_->count_bytes(name_, -static_cast<std::int64_t>(allocated_));
    host_copy_ = nullptr;
    texels_ = nullptr;
    buffer_ = nullptr;
    memory_ = nullptr;
    device_ = nullptr;
}

}  // namespace edgesplat::gpu

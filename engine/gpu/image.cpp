#include "engine/gpu/image.h"

#include <utility>

#include "engine/error.h"

namespace edgesplat::gpu {

namespace {

vk::ImageCreateInfo create_info(const ImageShape& shape) {
    const vk::Extent3D extent(static_cast<std::uint32_t>(shape.size.x), static_cast<std::uint32_t>(shape.size.y),
                              static_cast<std::uint32_t>(shape.size.z));
    return {{},
            shape.volume ? vk::ImageType::e3D : vk::ImageType::e2D,
            shape.format,
            extent,
            1,
            static_cast<std::uint32_t>(shape.layers),
            vk::SampleCountFlagBits::e1,
            vk::ImageTiling::eOptimal,
            shape.usage};
}

}  // namespace

std::uint64_t required_bytes(const Device& device, const ImageShape& shape) {
    const vk::ImageCreateInfo info = create_info(shape);
    return device.handle().getImageMemoryRequirements(vk::DeviceImageMemoryRequirements(&info)).memoryRequirements.size;
}

std::string exceeds_limits(const Device& device, const ImageShape& shape) {
    const auto limits = device.physical().getProperties().limits;
    const auto longest = static_cast<std::uint32_t>(glm::max(shape.size.x, glm::max(shape.size.y, shape.size.z)));
    const std::uint32_t most = shape.volume ? limits.maxImageDimension3D : limits.maxImageDimension2D;
    if (longest > most) return fmt::format("{} texels along one axis; {} allows {}", longest, device.info().name, most);
    if (static_cast<std::uint32_t>(shape.layers) > limits.maxImageArrayLayers)
        return fmt::format("{} layers; {} allows {}", shape.layers, device.info().name, limits.maxImageArrayLayers);
    return "";
}

GpuImage::GpuImage(const Device& device, const ImageShape& shape, const char* name) : shape_(shape), name_(name) {
    const std::string beyond = exceeds_limits(device, shape);
    if (!beyond.empty()) fail("{}: {}", name, beyond);
    const auto layers = static_cast<std::uint32_t>(shape.layers);
    image_ = vk::raii::Image(device.handle(), create_info(shape));
    const auto requirements = image_.getMemoryRequirements();
    memory_ = device.allocate(requirements, vk::MemoryPropertyFlagBits::eDeviceLocal, {}, false, name);
    image_.bindMemory(*memory_, 0);
    const auto view_type = shape.volume  ? vk::ImageViewType::e3D
                           : shape.array ? vk::ImageViewType::e2DArray
                                         : vk::ImageViewType::e2D;
    view_ = vk::raii::ImageView(device.handle(), vk::ImageViewCreateInfo({}, *image_, view_type, shape.format, {},
                                                                         {aspect(), 0, 1, 0, layers}));
    allocated_ = requirements.size;
    device.count_bytes(name_, static_cast<std::int64_t>(allocated_));
    device_ = &device;
}

GpuImage& GpuImage::operator=(GpuImage&& other) noexcept {
    if (this == &other) return *this;
    release();
    device_ = std::exchange(other.device_, nullptr);
    memory_ = std::move(other.memory_);
    image_ = std::move(other.image_);
    view_ = std::move(other.view_);
    shape_ = other.shape_;
    name_ = std::move(other.name_);
    allocated_ = std::exchange(other.allocated_, 0);
    return *this;
}

vk::ImageAspectFlags GpuImage::aspect() const {
    return shape_.format == vk::Format::eD16Unorm ? vk::ImageAspectFlagBits::eDepth : vk::ImageAspectFlagBits::eColor;
}

void GpuImage::release() noexcept {
    if (device_ == nullptr) return;
    device_->count_bytes(name_, -static_cast<std::int64_t>(allocated_));
    view_ = nullptr;
    image_ = nullptr;
    memory_ = nullptr;
    device_ = nullptr;
}

}  // namespace edgesplat::gpu

// An image with its own memory and one view. Move-only. Always in layout GENERAL once `Commands` has prepared it.
#pragma once

#include <glm/glm.hpp>
#include <vulkan/vulkan_raii.hpp>

#include "engine/gpu/device.h"

namespace edgesplat::gpu {

struct ImageShape {
    vk::Format format;
    glm::ivec3 size;  ///< texels; z > 1 with `volume`
    int layers = 1;
    bool volume = false;  ///< a 3-D image; else a 2-D array
    bool array = false;   ///< the view is an array even with one layer
    vk::ImageUsageFlags usage;
};

/// Device memory of an image, bytes. Precondition: exceeds_limits() is empty.
std::uint64_t required_bytes(const Device& device, const ImageShape& shape);

/// Error text with the numbers if the shape exceeds a limit of the device, else empty.
std::string exceeds_limits(const Device& device, const ImageShape& shape);

class GpuImage {
  public:
    GpuImage() = default;
    /// Throws Error with the device's limit if the image is too large or its memory cannot be allocated.
    GpuImage(const Device& device, const ImageShape& shape, const char* name);
    ~GpuImage() { release(); }
    GpuImage(GpuImage&& other) noexcept { *this = std::move(other); }
    GpuImage& operator=(GpuImage&& other) noexcept;
    GpuImage(const GpuImage&) = delete;
    GpuImage& operator=(const GpuImage&) = delete;

    vk::Image handle() const { return *image_; }
    vk::ImageView view() const { return *view_; }
    const ImageShape& shape() const { return shape_; }
    vk::ImageAspectFlags aspect() const;
    explicit operator bool() const { return device_ != nullptr; }

  private:
    void release() noexcept;
    const Device* device_ = nullptr;
    vk::raii::DeviceMemory memory_ = nullptr;
    vk::raii::Image image_ = nullptr;
    vk::raii::ImageView view_ = nullptr;
    ImageShape shape_{};
    std::string name_;
    std::uint64_t allocated_ = 0;
};

}  // namespace edgesplat::gpu

// The descriptor set: binds resources to slots (shaders/shared/bindings.h).
#pragma once

#include "engine/gpu/buffer.h"
#include "engine/gpu/image.h"
#include "engine/gpu/pipelines.h"
#include "shaders/shared/bindings.h"

namespace edgesplat::gpu {

/// Slots are written between runs, never while the device executes one.
class DescriptorSet {
  public:
    DescriptorSet(const Device& device, const Pipelines& pipelines);

    vk::DescriptorSet handle() const { return *set_; }

    /// With a sampler: as a texture, else as a storage image. A slot always gets the same sampler.
    void put_image(std::uint32_t slot, const GpuImage& image, vk::Sampler sampler = {});
    void put_texels(std::uint32_t slot, const Buffer& buffer);
    void put_block(std::uint32_t slot, const Buffer& block);

  private:
    void put(std::uint32_t slot, vk::WriteDescriptorSet write);
    const Device* device_;
    vk::raii::DescriptorPool pool_ = nullptr;
    vk::raii::DescriptorSet set_ = nullptr;
};

}  // namespace edgesplat::gpu

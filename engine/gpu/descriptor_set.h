// The descriptor set: which resource stands in which slot (shaders/shared/bindings.h).
#pragma once

#include <array>

#include "engine/gpu/buffer.h"
#include "engine/gpu/image.h"
#include "engine/gpu/pipelines.h"
#include "shaders/shared/bindings.h"

namespace edgesplat::gpu {

/// Slots are written only where what is put there is another resource, since a write ends the life of every command
/// buffer that was recorded with the set.
class DescriptorSet {
  public:
    DescriptorSet(const Device& device, const Pipelines& pipelines);

    vk::DescriptorSet handle() const { return *set_; }
    /// Another after every write, and another than any other set's.
    std::uint64_t version() const { return version_; }

    /// With a sampler: as a texture. One slot has always the same sampler.
    void put_image(std::uint32_t slot, const GpuImage& image, vk::Sampler sampler = {});
    void put_texels(std::uint32_t slot, const Buffer& buffer);
    void put_block(std::uint32_t slot, const Buffer& block);

  private:
    void put(std::uint32_t slot, std::uint64_t serial, vk::WriteDescriptorSet write);
    const Device* device_;
    vk::raii::DescriptorPool pool_ = nullptr;
    vk::raii::DescriptorSet set_ = nullptr;
    std::array<std::uint64_t, shader::BIND_COUNT> held_{};  ///< serials
    std::uint64_t version_;
};

}  // namespace edgesplat::gpu

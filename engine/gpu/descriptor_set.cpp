#include "engine/gpu/descriptor_set.h"

#include <array>

namespace edgesplat::gpu {

DescriptorSet::DescriptorSet(const Device& device, const Pipelines& pipelines) : device_(&device) {
    using Type = vk::DescriptorType;
    const std::array sizes{
        vk::DescriptorPoolSize(Type::eStorageImage, shader::BIND_SHEETS),
        vk::DescriptorPoolSize(Type::eCombinedImageSampler, shader::BIND_SCENE - shader::BIND_SHEETS),
        vk::DescriptorPoolSize(Type::eUniformBuffer, shader::BIND_PICTURE - shader::BIND_SCENE),
        vk::DescriptorPoolSize(Type::eStorageTexelBuffer, shader::BIND_COUNT - shader::BIND_PICTURE)};
    pool_ = vk::raii::DescriptorPool(device.handle(), {vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet, 1, sizes});
    const auto layout = pipelines.set_layout();
    set_ = std::move(vk::raii::DescriptorSets(device.handle(), {*pool_, layout}).front());
}

void DescriptorSet::put(std::uint32_t slot, vk::WriteDescriptorSet write) {
    write.setDstSet(*set_).setDstBinding(slot).setDescriptorCount(1);
    device_->handle().updateDescriptorSets(write, nullptr);
}

void DescriptorSet::put_image(std::uint32_t slot, const GpuImage& image, vk::Sampler sampler) {
    const vk::DescriptorImageInfo info(sampler, image.view(), vk::ImageLayout::eGeneral);
    put(slot,
        vk::WriteDescriptorSet()
            .setDescriptorType(sampler ? vk::DescriptorType::eCombinedImageSampler : vk::DescriptorType::eStorageImage)
            .setPImageInfo(&info));
}

void DescriptorSet::put_texels(std::uint32_t slot, const Buffer& buffer) {
    const vk::BufferView texels = buffer.texels();
    put(slot, vk::WriteDescriptorSet()
                  .setDescriptorType(vk::DescriptorType::eStorageTexelBuffer)
                  .setPTexelBufferView(&texels));
}

void DescriptorSet::put_block(std::uint32_t slot, const Buffer& block) {
    const vk::DescriptorBufferInfo info(block.handle(), 0, block.bytes());
    put(slot, vk::WriteDescriptorSet().setDescriptorType(vk::DescriptorType::eUniformBuffer).setPBufferInfo(&info));
}

}  // namespace edgesplat::gpu

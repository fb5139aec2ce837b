#include "engine/plan/resources.h"

#include <algorithm>
#include <cstring>

#include "engine/plan/resource_table.h"

namespace edgesplat {

Bindings::Bindings(const gpu::Device& device, const gpu::Pipelines& pipelines) : set_(device, pipelines) {
    vk::SamplerCreateInfo sampler;
    sampler.setAddressModeU(vk::SamplerAddressMode::eClampToEdge).setAddressModeV(vk::SamplerAddressMode::eClampToEdge);
    nearest_ = vk::raii::Sampler(device.handle(), sampler);
    sampler.setMinFilter(vk::Filter::eLinear).setMagFilter(vk::Filter::eLinear);
    linear_ = vk::raii::Sampler(device.handle(), sampler);
    for (const gpu::ImageShape& shape : placeholder_images())
        no_images_.emplace_back(device, shape, kPlaceholder.name);
    for (const vk::Format format : placeholder_texels())
        no_texels_.emplace_back(device, kPlaceholderBytes, gpu::Buffer::Place::Device, kPlaceholderTexels.name, format);
    no_block_ = gpu::Buffer(device, sizeof(shader::FrameBlock), gpu::Buffer::Place::Host, kPlaceholderBlock.name);
}

void Bindings::prepare(gpu::Commands& commands) const {
    for (const gpu::GpuImage& image : no_images_)
        commands.prepare({&image});
}

void Bindings::put_image(std::uint32_t binding, const gpu::GpuImage& image, const gpu::ImageShape& kind,
                         vk::Sampler sampler) {
    const auto placeholder = std::ranges::find_if(no_images_, [&](const gpu::GpuImage& other) {
        const gpu::ImageShape& shape = other.shape();
        return shape.volume == kind.volume && shape.array == kind.array &&
               (sampler ? bool(shape.usage & vk::ImageUsageFlagBits::eSampled) : shape.format == kind.format);
    });
    set_.put_image(binding, image ? image : *placeholder, sampler);
}

void Bindings::write_volume(const VolumeImages& images) {
    for (const auto& row : volume_image_rows())
        put_image(row.binding, images.*row.image, row.kind);
}

void Bindings::write_splats(const SplatLists& lists) {
    for (const auto& row : field_image_rows())
        put_image(row.binding, lists.*row.image, row.kind);
    set_.put_block(shader::BIND_SCENE, lists.scene ? lists.scene : no_block_);
    set_.put_block(shader::BIND_LIGHT, no_block_);
}

void Bindings::write_targets(const TargetResources& targets) {
    for (const TargetImageRow& row : target_image_rows()) {
        const bool sampled = row.sampling != Sampling::None;
        if (row.binding == kUnbound) continue;
        put_image(row.binding, targets.*row.image, row.kind,
                  !sampled                           ? vk::Sampler{}
                  : row.sampling == Sampling::Linear ? *linear_
                                                     : *nearest_);
    }
    for (const TargetBufferRow& row : target_buffer_rows()) {
        if (row.binding == kUnbound) continue;
        const gpu::Buffer& buffer = targets.*row.buffer;
        const auto placeholder = std::ranges::find(placeholder_texels(), row.texels) - placeholder_texels().begin();
        set_.put_texels(row.binding,
                        buffer && buffer.texels() ? buffer : no_texels_[static_cast<std::size_t>(placeholder)]);
    }
    set_.put_block(shader::BIND_FRAME, targets.frame ? targets.frame : no_block_);
}

namespace {

constexpr std::size_t kStagingBytes = std::size_t{64} << 20U;

/// Rows and slices of one upload. A slice larger than the staging buffer is uploaded in bands of rows.
struct Band {
    std::size_t row = 0;  ///< bytes
    std::size_t rows = 0, slices = 0;
};

Band upload_band(const gpu::ImageShape& shape, std::size_t texel_bytes) {
    const auto row = static_cast<std::size_t>(shape.size.x) * texel_bytes;
    const auto height = static_cast<std::size_t>(shape.size.y);
    const auto slices = static_cast<std::size_t>(shape.volume ? shape.size.z : shape.layers);
    const std::size_t rows = std::clamp<std::size_t>(kStagingBytes / row, 1, height);
    return {row, rows, rows < height ? 1 : std::clamp<std::size_t>(kStagingBytes / (row * height), 1, slices)};
}

}  // namespace

std::uint64_t staging_bytes(const gpu::ImageShape& shape, std::size_t texel_bytes) {
    const Band band = upload_band(shape, texel_bytes);
    return band.row * band.rows * band.slices;
}

void upload_image(gpu::Commands& commands, const gpu::Device& device, const gpu::GpuImage& image, const void* bytes,
                  std::size_t texel_bytes) {
    upload_block(commands, device, image, image.shape().size, bytes, texel_bytes);
}

void upload_block(gpu::Commands& commands, const gpu::Device& device, const gpu::GpuImage& image,
                  const glm::ivec3& size, const void* bytes, std::size_t texel_bytes) {
    commands.run([&] { commands.prepare({&image}); });
    upload_box(commands, device, image, glm::ivec3(0), size, bytes, texel_bytes);
}

void upload_box(gpu::Commands& commands, const gpu::Device& device, const gpu::GpuImage& image, const glm::ivec3& low,
                const glm::ivec3& size, const void* bytes, std::size_t texel_bytes) {
    auto shape = image.shape();
    shape.size = size;
    const auto [row, rows_at_once, slices_at_once] = upload_band(shape, texel_bytes);
    const auto slice = row * static_cast<std::size_t>(shape.size.y);
    const auto slices = static_cast<std::size_t>(shape.volume ? shape.size.z : shape.layers);
    const gpu::Buffer staging(device, slices_at_once * rows_at_once * row, gpu::Buffer::Place::Host,
                              kStagingBuffer.name);
    for (std::size_t z = 0; z < slices; z += slices_at_once) {
        const std::size_t depth = std::min(slices_at_once, slices - z);
        for (std::size_t y = 0; y < static_cast<std::size_t>(shape.size.y); y += rows_at_once) {
            const std::size_t rows = std::min(rows_at_once, static_cast<std::size_t>(shape.size.y) - y);
            std::memcpy(staging.mapped<char>(staging.bytes()).data(),
                        static_cast<const char*>(bytes) + z * slice + y * row, depth * rows * row);
            const auto layer = static_cast<std::uint32_t>(shape.volume ? 0 : z);
            const vk::ImageSubresourceLayers layers(image.aspect(), 0, layer,
                                                    static_cast<std::uint32_t>(shape.volume ? 1 : depth));
            const vk::BufferImageCopy copy(
                0, 0, 0, layers, {low.x, low.y + static_cast<int>(y), low.z + static_cast<int>(shape.volume ? z : 0)},
                {static_cast<std::uint32_t>(shape.size.x), static_cast<std::uint32_t>(rows),
                 static_cast<std::uint32_t>(shape.volume ? depth : 1)});
            commands.run([&] { commands.copy(staging, image, copy); });
        }
    }
}

}  // namespace edgesplat

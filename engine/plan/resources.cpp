#include "engine/plan/resources.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "shaders/shared/footprint_table.h"

namespace edgesplat {
namespace {

using Usage = vk::ImageUsageFlagBits;

constexpr std::size_t kStagingBytes = std::size_t{64} << 20U;

gpu::GpuImage placeholder(const gpu::Device& device, vk::Format format, bool volume, bool array,
                          vk::ImageUsageFlags usage) {
    return {
        device, {.format = format, .size = {1, 1, 1}, .volume = volume, .array = array, .usage = usage}, "placeholder"};
}

}  // namespace

gpu::ImageShape footprint_table_shape() {
    return {.format = vk::Format::eR16Sfloat,
            .size = {static_cast<int>(shader::TABLE_WIDTH), static_cast<int>(shader::TABLE_ROWS), 1},
            .layers = static_cast<int>(shader::TABLE_LAYERS),
            .array = true,
            .usage = Usage::eSampled | Usage::eTransferDst | Usage::eTransferSrc};
}

Bindings::Bindings(const gpu::Device& device, const gpu::Pipelines& pipelines) : set_(device, pipelines) {
    vk::SamplerCreateInfo sampler;
    sampler.setAddressModeU(vk::SamplerAddressMode::eClampToEdge).setAddressModeV(vk::SamplerAddressMode::eClampToEdge);
    nearest_ = vk::raii::Sampler(device.handle(), sampler);
    sampler.setMinFilter(vk::Filter::eLinear).setMagFilter(vk::Filter::eLinear);
    linear_ = vk::raii::Sampler(device.handle(), sampler);
    no_scalar_ = placeholder(device, vk::Format::eR32Sfloat, true, false, Usage::eStorage);
    no_edges_ = placeholder(device, vk::Format::eR32G32Uint, true, false, Usage::eStorage);
    no_mask_ = placeholder(device, vk::Format::eR8Uint, true, false, Usage::eStorage);
    no_records_ = placeholder(device, vk::Format::eR32G32B32A32Sfloat, false, false, Usage::eStorage);
    no_array_ = placeholder(device, vk::Format::eR16Sfloat, false, true, Usage::eSampled);
    no_block_ = gpu::Buffer(device, sizeof(shader::FrameParams), gpu::Buffer::Place::Host, "placeholder block");
    no_texels_ =
        gpu::Buffer(device, 16, gpu::Buffer::Place::Device, "placeholder texels", vk::Format::eR32G32B32A32Sfloat);
    no_counts_ = gpu::Buffer(device, 16, gpu::Buffer::Place::Device, "placeholder counts", vk::Format::eR32Uint);
    no_entries_ = gpu::Buffer(device, 16, gpu::Buffer::Place::Device, "placeholder entries", vk::Format::eR32G32Uint);
    no_picture_ = placeholder(device, vk::Format::eR32Sfloat, false, false, Usage::eSampled);
}

void Bindings::prepare(gpu::Commands& commands) const {
    commands.prepare({&no_scalar_, &no_edges_, &no_mask_, &no_records_, &no_array_, &no_picture_});
}

void Bindings::write_volume(const VolumeResources& volume) {
    set_.put_image(shader::BIND_VOLUME, volume.volume ? volume.volume : no_scalar_);
    set_.put_image(shader::BIND_COEFFICIENTS, volume.coefficients ? volume.coefficients : no_scalar_);
    set_.put_image(shader::BIND_EDGES, volume.edges ? volume.edges : no_edges_);
}

void Bindings::write(const VolumeResources& volume, const TargetResources& targets) {
    write_volume(volume);
    set_.put_image(shader::BIND_BURIED, volume.buried ? volume.buried : no_mask_);
    set_.put_image(shader::BIND_PREPARED, targets.prepared ? targets.prepared : no_records_);
    set_.put_image(shader::BIND_SHEETS, targets.sheets ? targets.sheets : no_array_, *nearest_);
    set_.put_image(shader::BIND_ACCUMULATED, targets.accumulated ? targets.accumulated : no_picture_, *nearest_);
    set_.put_image(shader::BIND_TABLE, targets.footprint_table ? targets.footprint_table : no_array_, *linear_);
    const std::array texels{
        std::pair{&targets.output, &no_texels_},        std::pair{&targets.tile_counters, &no_counts_},
        std::pair{&targets.tile_closed, &no_counts_},   std::pair{&targets.tile_todo, &no_counts_},
        std::pair{&targets.tile_entries, &no_entries_}, std::pair{&targets.tile_marks, &no_counts_},
        std::pair{&targets.tile_ranges, &no_entries_},  std::pair{&targets.tile_order, &no_counts_},
        std::pair{&targets.tile_pixels, &no_counts_},   std::pair{&targets.tile_sheets, &no_texels_},
        std::pair{&targets.outlines, &no_counts_}};
    for (std::uint32_t i = 0; i < texels.size(); ++i) {
        const auto& [buffer, otherwise] = texels.at(i);
        set_.put_texels(shader::BIND_PICTURE + i, *buffer && buffer->texels() ? *buffer : *otherwise);
    }
    set_.put_block(shader::BIND_SCENE, volume.scene ? volume.scene : no_block_);
    set_.put_block(shader::BIND_FRAME, targets.frame ? targets.frame : no_block_);
    set_.put_block(shader::BIND_OCCLUSION, no_block_);
}

namespace {

/// Rows and slices that go up at once. A slice may be larger than the staging buffer should be; then it goes up in
/// bands of rows.
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
    const gpu::Buffer staging(device, slices_at_once * rows_at_once * row, gpu::Buffer::Place::Host, "staging buffer");
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

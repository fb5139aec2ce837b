// The table of a renderer's images and buffers, one row each. Allocation, binding, memory forecast and description all
// read it.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "engine/plan/plan.h"
#include "engine/plan/resources.h"

namespace edgesplat {

/// Description of a resource for readers.
struct ResourceText {
    const char* name = "";           ///< also the name of its allocation
    std::string_view contents;       ///< "(splats) uint"
    std::string_view written, read;  ///< stems of passes, or "host"
};

/// Binding of resources that passes access by address only.
inline constexpr std::uint32_t kUnbound = ~0U;

/// An image with one texel per voxel: as large as the volume, or as its largest block.
template <typename Owner>
struct VolumeImageRow {
    ResourceText text;
    gpu::GpuImage Owner::*image;
    std::uint32_t binding;
    gpu::ImageShape kind;                 ///< shape without size
    bool (*held)(const CollectionPlan&);  ///< whether the plan needs it
    gpu::ImageShape shape(const glm::ivec3& size) const;
};
std::span<const VolumeImageRow<VolumeImages>> volume_image_rows();
const VolumeImageRow<VolumeImages>& row_of(gpu::GpuImage VolumeImages::*image);
/// Fields over the voxels that pass 2 reads: edges and buried voxels.
std::span<const VolumeImageRow<SplatLists>> field_image_rows();

/// A buffer of passes 1 and 2, mapped; its size depends on the plan and on the voxels collected at once.
struct CollectionBufferRow {
    ResourceText text;
    gpu::Buffer SplatLists::*buffer;
    std::uint64_t (*bytes)(const CollectionPlan&, const glm::ivec3& core_size);  ///< 0: none
};
std::span<const CollectionBufferRow> collection_buffer_rows();

/// A list with one element per splat.
struct SplatListRow {
    ResourceText text;
    gpu::Buffer SplatLists::*list;
    shader::Address shader::SceneParams::*collected;  ///< its address for pass 2
    shader::Address shader::VolumeParams::*drawn;     ///< its address for a picture's passes
    std::uint64_t (*bytes)(const CollectionPlan&);    ///< size of an element; 0: no list
};
std::span<const SplatListRow> splat_list_rows();

/// A list of the light that reaches each splat, 4 bytes per splat; exists if the scene needs it.
struct LightListRow {
    ResourceText text;
    gpu::Buffer SplatLists::*list;
    shader::Address shader::VolumeParams::*drawn;
};
inline constexpr std::uint64_t kLightBytes = 4;
std::span<const LightListRow> light_list_rows();
const LightListRow& row_of(gpu::Buffer SplatLists::*list);

/// Filter of a sampled image; None: a storage image or attachment.
enum class Sampling { None, Nearest, Linear };

/// An image of a picture.
struct TargetImageRow {
    ResourceText text;
    gpu::GpuImage TargetResources::*image;
    std::uint32_t binding;
    Sampling sampling;
    gpu::ImageShape kind;  ///< shape without size
    /// Width, height, layers; nullopt: the plan does not need it.
    std::optional<glm::ivec3> (*size)(const FramePlan&);
    bool taller_is_reusable = false;  ///< an image with more rows can be reused
    gpu::ImageShape shape(const glm::ivec3& size_and_layers) const;
};
std::span<const TargetImageRow> target_image_rows();

/// A buffer of a picture.
struct TargetBufferRow {
    ResourceText text;
    gpu::Buffer TargetResources::*buffer;
    shader::Address shader::FrameParams::*address;  ///< its address for the passes; null: they do not use one
    gpu::Buffer::Place place;
    vk::Format texels;      ///< format if shaders also load it as texels, else undefined
    std::uint32_t binding;  ///< binding of the texels
    /// Size in bytes; 0: the plan does not need it.
    std::uint64_t (*bytes)(const FramePlan&, const gpu::DeviceProfile&);
    bool always = false;  ///< allocated with the renderer and never freed
};
std::span<const TargetBufferRow> target_buffer_rows();
const TargetBufferRow& row_of(gpu::Buffer TargetResources::*buffer);

/// Placeholders for unused bindings.
inline constexpr ResourceText kPlaceholder{"placeholder", "1 texel", "-", "-"};
inline constexpr ResourceText kPlaceholderTexels{"placeholder texels", "zeros", "-", "-"};
inline constexpr ResourceText kPlaceholderBlock{"placeholder block", "zeros", "-", "-"};
inline constexpr std::uint64_t kPlaceholderBytes = 16;
std::span<const gpu::ImageShape> placeholder_images();
std::span<const vk::Format> placeholder_texels();

/// Temporary resources.
inline constexpr ResourceText kStagingBuffer{"staging buffer", "(rows) texels", "host", "copies"};
inline constexpr ResourceText kLightBlock{"light parameters", "(1) LightParams", "host", "2b, 2c"};

}  // namespace edgesplat

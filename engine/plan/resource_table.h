// Every image and buffer of a renderer, a row each: what allocates, binds, forecasts and describes them reads it there.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "engine/plan/plan.h"
#include "engine/plan/resources.h"

namespace edgesplat {

/// For those who read what a frame takes.
struct ResourceText {
    const char* name = "";           ///< as it is allocated
    std::string_view contents;       ///< "(splats) uint"
    std::string_view written, read;  ///< stems of passes, or "host"
};

/// Of what passes have by its address alone.
inline constexpr std::uint32_t kUnbound = ~0U;

/// A voxel's texel each: as large as the volume, or as the largest of its blocks.
template <typename Owner>
struct VolumeImageRow {
    ResourceText text;
    gpu::GpuImage Owner::*image;
    std::uint32_t binding;
    gpu::ImageShape kind;                 ///< without size
    bool (*held)(const CollectionPlan&);  ///< whether there is one
    gpu::ImageShape shape(const glm::ivec3& size) const;
};
std::span<const VolumeImageRow<VolumeImages>> volume_image_rows();
const VolumeImageRow<VolumeImages>& row_of(gpu::GpuImage VolumeImages::*image);
/// What is known of each voxel before it becomes a splat.
std::span<const VolumeImageRow<SplatLists>> field_image_rows();

/// Mapped, of a plan and the voxels that become splats at once.
struct CollectionBufferRow {
    ResourceText text;
    gpu::Buffer SplatLists::*buffer;
    std::uint64_t (*bytes)(const CollectionPlan&, const glm::ivec3& core_size);  ///< 0: none
};
std::span<const CollectionBufferRow> collection_buffer_rows();

/// A list with an element for each splat.
struct SplatListRow {
    ResourceText text;
    gpu::Buffer SplatLists::*list;
    shader::Address shader::SceneParams::*collected;  ///< where pass 2 finds it
    shader::Address shader::FrameParams::*drawn;      ///< where the passes of a picture do
    std::uint64_t (*bytes)(const CollectionPlan&);    ///< of an element; 0: none
};
std::span<const SplatListRow> splat_list_rows();

/// What of the light reaches the splats, 4 bytes each: there where a scene calls for it.
struct LightListRow {
    ResourceText text;
    gpu::Buffer SplatLists::*list;
    shader::Address shader::FrameParams::*drawn;
};
inline constexpr std::uint64_t kLightBytes = 4;
std::span<const LightListRow> light_list_rows();
const LightListRow& row_of(gpu::Buffer SplatLists::*list);

/// How shaders read an image that they do not load.
enum class Sampling { None, Nearest, Linear };

/// Of a picture.
struct TargetImageRow {
    ResourceText text;
    gpu::GpuImage TargetResources::*image;
    std::uint32_t binding;
    Sampling sampling;
    gpu::ImageShape kind;  ///< without size
    /// Width, height, layers; nothing: pictures of that plan have none.
    std::optional<glm::ivec3> (*size)(const FramePlan&);
    bool higher_serves = false;  ///< one of more rows does as well
    gpu::ImageShape shape(const glm::ivec3& size_and_layers) const;
};
std::span<const TargetImageRow> target_image_rows();

struct TargetBufferRow {
    ResourceText text;
    gpu::Buffer TargetResources::*buffer;
    shader::Address shader::FrameParams::*address;  ///< null: none of the picture's passes asks for it
    gpu::Buffer::Place place;
    vk::Format texels;      ///< that shaders have it as, too
    std::uint32_t binding;  ///< then
    /// 0: pictures of that plan have none.
    std::uint64_t (*bytes)(const FramePlan&, const gpu::DeviceProfile&);
    bool always = false;  ///< every renderer has it, from the beginning
};
std::span<const TargetBufferRow> target_buffer_rows();
const TargetBufferRow& row_of(gpu::Buffer TargetResources::*buffer);

/// What stands in bindings that a frame does not use.
inline constexpr ResourceText kPlaceholder{"placeholder", "1 texel", "-", "-"};
inline constexpr ResourceText kPlaceholderTexels{"placeholder texels", "zeros", "-", "-"};
inline constexpr ResourceText kPlaceholderBlock{"placeholder block", "zeros", "-", "-"};
inline constexpr std::uint64_t kPlaceholderBytes = 16;
std::span<const gpu::ImageShape> placeholder_images();
std::span<const vk::Format> placeholder_texels();

/// What is held for a moment.
inline constexpr ResourceText kStagingBuffer{"staging buffer", "(rows) texels", "host", "copies"};
inline constexpr ResourceText kOcclusionBlock{"occlusion parameters", "(1) OcclusionParams", "host", "2b"};
inline constexpr ResourceText kLightLayers{"light layers", "(layers, y, x) optical depth from the light", "2c", "2d"};

}  // namespace edgesplat

// A renderer's resources on the device, the descriptor set that binds them, and uploads into images.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/gpu/buffer.h"
#include "engine/gpu/commands.h"
#include "engine/gpu/image.h"
#include "engine/plan/plan.h"
#include "shaders/shared/bindings.h"

namespace edgesplat {

/// Resources that last until the volume or its resolution changes. The row of each (resource_table.h) tells its
/// contents and when it exists.
struct VolumeImages {
    gpu::GpuImage volume, coefficients, labels;
};

/// Resources that last until the volume, the scene's materials or the edge settings change; rows likewise.
struct SplatLists {
    gpu::GpuImage edges, buried;
    gpu::Buffer scene, run_offsets, listed_bricks, transfer;
    gpu::Buffer splats, traits, values, labels, occlusion, shadows;
    bool surfaces = false;       ///< CollectionPlan::surfaces
    std::uint32_t border = ~0U;  ///< faces_with_matter; only with surface splats
    std::uint64_t splat_count = 0, edge_splat_count = 0, crease_splat_count = 0, traced_splat_count = 0;
    glm::ivec3 box_low{0}, box_high{0};  ///< inclusive bounding box of the splats' voxels
    SplatBricks bricks;                  ///< the list's bricks
    SplatExtent extent() const {
        return {splat_count, box_low, box_high, crease_splat_count > 0, traced_splat_count > 0, surfaces, border};
    }
};

/// Resources that last until the picture's size or the number of sheets or splats changes; rows likewise.
struct TargetResources {
    gpu::Buffer frame, drawn, indices;
    gpu::Buffer label_colors;
    gpu::Buffer batches, sheet_of, order, counters, output;
    gpu::GpuImage footprint_table;
    gpu::Buffer footprints;
    // Pictures whose sheets are layers.
    gpu::GpuImage sheets, depth, accumulated;
    gpu::Buffer groups, draws;
    // Tiled pictures.
    gpu::GpuImage prepared;
    gpu::Buffer tile_rects, sheet_pairs, sheet_starts, chunks, tile_counters, tile_ranges, tile_order, tile_entries;
    gpu::Buffer tile_marks, tile_closed, tile_todo, tile_closed_on_host, tile_finest, tile_pixels, tile_sheets,
        outlines;
    gpu::Buffer traced_rays, traced_entries;
    gpu::Buffer seen_surfaces, seen_ways, surfaces_passed, tile_ends;
    gpu::Buffer nearest_surfaces, nearest_ways;
};

/// The one descriptor set (shaders/shared/bindings.h). Unused bindings get a placeholder, a 1-texel image or zeros,
/// since not every driver allows empty bindings.
class Bindings {
  public:
    Bindings(const gpu::Device& device, const gpu::Pipelines& pipelines);
    gpu::DescriptorSet& set() { return set_; }
    const gpu::DescriptorSet& set() const { return set_; }
    /// Records the placeholders' transition to layout GENERAL; call once.
    void prepare(gpu::Commands& commands) const;
    void write_volume(const VolumeImages& images);
    void write_splats(const SplatLists& lists);
    void write_targets(const TargetResources& targets);

  private:
    gpu::DescriptorSet set_;
    /// Binds `image`, or a placeholder of its kind if there is none.
    void put_image(std::uint32_t binding, const gpu::GpuImage& image, const gpu::ImageShape& kind,
                   vk::Sampler sampler = {});
    vk::raii::Sampler nearest_ = nullptr, linear_ = nullptr;
    std::vector<gpu::GpuImage> no_images_;  ///< placeholder_images()
    std::vector<gpu::Buffer> no_texels_;    ///< placeholder_texels()
    gpu::Buffer no_block_;
};

/// Size of the staging buffer that upload_image uses for such an image.
std::uint64_t staging_bytes(const gpu::ImageShape& shape, std::size_t texel_bytes);

/// Copies `bytes` from the host into an image through a staging buffer of at most 64 MiB (or one row).
/// `texel_bytes`: size of one texel.
void upload_image(gpu::Commands& commands, const gpu::Device& device, const gpu::GpuImage& image, const void* bytes,
                  std::size_t texel_bytes);
/// The same for the first `size` texels of a volume along each axis; the other texels become undefined.
void upload_block(gpu::Commands& commands, const gpu::Device& device, const gpu::GpuImage& image,
                  const glm::ivec3& size, const void* bytes, std::size_t texel_bytes);
/// The same from texel `low` on; the other texels keep their values.
void upload_box(gpu::Commands& commands, const gpu::Device& device, const gpu::GpuImage& image, const glm::ivec3& low,
                const glm::ivec3& size, const void* bytes, std::size_t texel_bytes);

}  // namespace edgesplat

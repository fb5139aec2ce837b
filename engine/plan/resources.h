// Every image and buffer of a frame in one place: shape, format, who writes it, who reads it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/culling/bricks.h"
#include "engine/gpu/buffer.h"
#include "engine/gpu/commands.h"
#include "engine/gpu/image.h"
#include "shaders/shared/bindings.h"

namespace edgesplat {

/// What stands until the volume, the scene's materials or the edge settings change.
struct VolumeResources {
    gpu::GpuImage volume;        ///< (z, y, x) r32f, scaled samples; host -> 1, 2
    gpu::GpuImage coefficients;  ///< (z, y, x) r32f; host -> 1, estimator `cubic` only
    gpu::GpuImage edges;         ///< (z, y, x) rg32ui; 1 -> 2; absent without edges and light
    gpu::GpuImage buried;        ///< (z, y, x) r8ui; 2a -> 2b; absent where nothing is buried
    gpu::Buffer scene;           ///< SceneParams; host -> 1, 2
    gpu::Buffer run_offsets;     ///< (runs + 2) uint, mapped; 2 <-> host
    gpu::Buffer splats;          ///< (splat_count) Splat, 12 bytes each; 2 -> 3, 5
    gpu::Buffer traits;          ///< (splat_count) uvec2: what else its face has; 2 -> 5; only with faces
    gpu::Buffer occlusion;       ///< (splat_count) uint: ambient light that reaches it; 2b -> 5; only with occlusion
    gpu::Buffer shadows;         ///< (splat_count) uint: light that reaches it; 2d -> 5; only with shadow lights
    gpu::Buffer transfer;  ///< (TRANSFER_ROWS + 1) TransferRow, mapped; host -> 2, 5; only with a transfer function
    gpu::Buffer values;    ///< (splat_count) float: what each splat is classified by; 2 -> 5; likewise
    std::uint64_t splat_count = 0, edge_splat_count = 0, crease_splat_count = 0;
    glm::ivec3 box_low{0}, box_high{0};  ///< inclusive box of voxels that holds all splats
    SplatBricks bricks;                  ///< of the list
};

/// What stands until the picture's size, the number of sheets or of splats changes. A picture whose sheets are layers
/// has the first three, `groups` and `draws`, one that is summed tile by tile what is of tiles.
struct TargetResources {
    gpu::GpuImage sheets;           ///< (sheets_per_group, height, width) rgba32f; 5 -> 6
    gpu::GpuImage depth;            ///< (sheets_per_group, height, width) d16; 5a -> 5b
    gpu::GpuImage accumulated;      ///< (height, width) rgba32f; 6 -> 5a, 7
    gpu::GpuImage footprint_table;  ///< (layers, y, x) r16f; host -> 5; footprints from a table only, as is
    gpu::Buffer footprints;         ///< (splat_count) uvec2: FrameParams::footprints; 3 -> 4, 5
    double table_depth = 0;         ///< the table's, voxels
    gpu::GpuImage prepared;   ///< rgba32f, PREPARED_ROW wide: records of a chunk's splats (prepared_splat.glsl); 4 -> 5
    gpu::Buffer batches;      ///< (splat_count / SPLAT_BATCH + 1) uvec2, mapped: FrameParams::batches; host -> 3, 4
    gpu::Buffer sheet_of;     ///< (splat_count) uint: of slots; 3 -> 4, 5
    gpu::Buffer order;        ///< (splat_count * sheets_per_splat) uint; 4 -> 5
    gpu::Buffer counters;     ///< (sheet_count, SORT_BLOCKS) uint; 4
    gpu::Buffer groups;       ///< (group_count) SheetGroup; host, 3, 4 -> 5, 6
    gpu::Buffer draws;        ///< (group_count) DrawCommand; 4 -> 5
    gpu::Buffer drawn;        ///< (3) uint, mapped: FrameParams::drawn; 4, 5 -> host
    gpu::Buffer frame;        ///< FrameParams, mapped; host -> 3..7
    gpu::Buffer indices;      ///< quad_indices(); host -> 5
    gpu::Buffer tile_rects;   ///< (splat_count) uvec2: tiles each splat touches; 3 -> 4
    gpu::Buffer sheet_pairs;  ///< (sheet_count) uint, mapped: pairs of splats and tiles; 3 -> host
    gpu::Buffer sheet_starts;   ///< (sheet_count + 1) uint, mapped: into `order`; 4 -> 4, host
    gpu::Buffer chunks;         ///< (sheet_count) uvec2, mapped: parts of `order`; host -> 4
    gpu::Buffer tile_counters;  ///< (tiles, tile_blocks) uint; 4
    gpu::Buffer tile_ranges;    ///< (tiles) uvec2, mapped: parts of tile_entries; 4 -> 5, host
    gpu::Buffer tile_order;  ///< (tiles x groups of each) uint, mapped: longest list first; host -> 5; with rounds only
    gpu::Buffer tile_entries;  ///< (pairs of the largest chunk) uvec2: place in `order`, sheet; 4 -> 5
    gpu::Buffer tile_marks;    ///< (tile_mark_words) uint: which pixels entries are for, BIND_TILE_MARKS; 4 -> 5
    gpu::Buffer tile_closed;   ///< (tiles) uint: pixels that take no more; 5 -> 4
    gpu::Buffer tile_todo;     ///< (tiles) uint, mapped: pixels that are drawn; host, 5 -> 4, 5, host
    gpu::Buffer tiles_seen;    ///< (tiles) uint, mapped: tile_closed; 5 -> host; with refined pixels only
    gpu::Buffer tile_finest;   ///< (tiles) uint: FrameParams::tile_finest; 5 -> 5; with refined pixels only
    gpu::Buffer tile_pixels;   ///< (tiles, TILE * TILE) uint: which; 5 -> 5; with refined pixels only
    gpu::Buffer tile_sheets;   ///< (height, width) vec4: sums of a sheet that a round leaves unfinished; 5
    gpu::Buffer outlines;      ///< (height, width) uint: BIND_OUTLINES; 5 -> 7; with smooth outlines only
    gpu::Buffer output;        ///< (height, width) vec4, mapped; 5, 7 -> host
};

/// The one descriptor set (shaders/shared/bindings.h). Bindings that a frame does not use hold a 1-texel image or
/// zeros, since not every driver allows holes.
class Bindings {
  public:
    Bindings(const gpu::Device& device, const gpu::Pipelines& pipelines);
    gpu::DescriptorSet& set() { return set_; }
    const gpu::DescriptorSet& set() const { return set_; }
    /// Moves the placeholders into layout GENERAL; once, while recording.
    void prepare(gpu::Commands& commands) const;
    void write(const VolumeResources& volume, const TargetResources& targets);
    /// Only what the volume's images alone say: samples, coefficients, edges.
    void write_volume(const VolumeResources& volume);

  private:
    gpu::DescriptorSet set_;
    vk::raii::Sampler nearest_ = nullptr, linear_ = nullptr;
    gpu::GpuImage no_scalar_, no_edges_, no_mask_, no_records_, no_array_, no_picture_;
    gpu::Buffer no_block_;
    gpu::Buffer no_texels_, no_counts_, no_entries_;
};

/// The image that holds the layers of footprints.
gpu::ImageShape footprint_table_shape();

/// Size of the staging buffer that upload_image uses for such an image.
std::uint64_t staging_bytes(const gpu::ImageShape& shape, std::size_t texel_bytes);

/// Copies `bytes` from the host into an image, whole layers or slices at a time, through a staging buffer of at most
/// 64 MiB. `texel_bytes` is the size of one texel.
void upload_image(gpu::Commands& commands, const gpu::Device& device, const gpu::GpuImage& image, const void* bytes,
                  std::size_t texel_bytes);
/// The same for the first `size` texels of a volume along each axis; what the others hold is lost.
void upload_block(gpu::Commands& commands, const gpu::Device& device, const gpu::GpuImage& image,
                  const glm::ivec3& size, const void* bytes, std::size_t texel_bytes);
/// The same from texel `low` on; what the others hold stays.
void upload_box(gpu::Commands& commands, const gpu::Device& device, const gpu::GpuImage& image, const glm::ivec3& low,
                const glm::ivec3& size, const void* bytes, std::size_t texel_bytes);

}  // namespace edgesplat

// RendererState: what a picture is drawn into.
#include <algorithm>

#include "engine/compositors/tiles/chunks.h"
#include "engine/error.h"
#include "engine/passes/4_prepare_splats.h"
#include "engine/renderer/state.h"
#include "footprints/face.h"
#include "footprints/footprint_table.h"

namespace edgesplat {
namespace {

using Place = gpu::Buffer::Place;
using Usage = vk::ImageUsageFlagBits;

constexpr std::size_t kWord = sizeof(std::uint32_t);

/// Makes `buffer` at least `bytes` long; what it held is lost if it grows.
void grow(const gpu::Device& device, gpu::Buffer& buffer, std::size_t bytes, Place place, const char* name,
          vk::Format texels = vk::Format::eUndefined) {
    if (buffer && buffer.bytes() >= bytes) return;
    buffer = {};
    buffer = gpu::Buffer(device, bytes, place, name, texels);
}

bool has_shape(const gpu::GpuImage& image, vk::Format format, const glm::ivec2& size, int layers) {
    return image && image.shape().format == format && image.shape().size == glm::ivec3(size, 1) &&
           image.shape().layers >= layers;
}

}  // namespace

void RendererState::need_layers(const Scene& scene, const Settings& settings) const {
    const std::string& obstacle = device.layers_obstacle();
    if (obstacle.empty()) return;
    if (drawn_as(settings, scene).sheet_format != SheetFormat::Tiles)
        fail("sheet_format: {} has {}, expected `tiles` there", device.info().name, obstacle);
    if (!shadow_lights(scene).empty())
        fail("shadows: {} has {}, expected lights without shadows there", device.info().name, obstacle);
}

void RendererState::provide_targets(FramePlan& plan_in_use) {
    auto& p = plan_in_use.params;
    provide_footprints(plan_in_use);
    grow(device, targets.batches, (p.splat_count / shader::SPLAT_BATCH + 1) * sizeof(glm::uvec2), Place::Shared,
         "batches of splats");
    std::ranges::copy(plan_in_use.batches, targets.batches.mapped<glm::uvec2>(plan_in_use.batches.size()).begin());
    grow(device, targets.sheet_of, p.splat_count * kWord, Place::Device, "sheets of splats");
    grow(device, targets.order, std::size_t{p.splat_count} * plan_in_use.sheets_per_splat * kWord, Place::Device,
         "splat order");
    grow(device, targets.counters, std::size_t{p.sheet_count} * shader::SORT_BLOCKS * kWord, Place::Device,
         "sort counters");
    grow(device, targets.output, picture_bytes(plan_in_use), Place::Shared, "output pixels",
         vk::Format::eR32G32B32A32Sfloat);

    p.splats = volume_resources.splats.address();
    p.traits = volume_resources.traits ? volume_resources.traits.address() : 0;
    p.splat_occlusion = volume_resources.occlusion ? volume_resources.occlusion.address() : 0;
    p.splat_shadows = volume_resources.shadows ? volume_resources.shadows.address() : 0;
    p.transfer = volume_resources.transfer ? volume_resources.transfer.address() : 0;
    p.values = volume_resources.values ? volume_resources.values.address() : 0;
    p.batches = targets.batches.address();
    p.sheets = targets.sheet_of.address();
    p.order = targets.order.address();
    p.counters = targets.counters.address();
    p.drawn = targets.drawn.address();
    p.output_pixels = targets.output.address();
    if (plan_in_use.variant.tiles)
        provide_tiles(plan_in_use);
    else
        provide_layers(plan_in_use);
    targets.frame.mapped<shader::FrameParams>(1)[0] = p;
    bindings.write(volume_resources, targets);
}

void RendererState::provide_footprints(FramePlan& plan_in_use) {
    auto& p = plan_in_use.params;
    if (plan_in_use.variant.footprints != FootprintMode::Table) {
        targets.footprints = {};
        targets.footprint_table = {};
        return;
    }
    grow(device, targets.footprints, p.splat_count * sizeof(glm::uvec2), Place::Device, "selected footprints");
    p.footprints = targets.footprints.address();
    const double depth = p.face_depth > static_cast<float>(kFaceDepth) ? kDeepFaceDepth : kFaceDepth;
    if (targets.footprint_table && targets.table_depth == depth) return;
    targets.footprint_table = {};
    targets.footprint_table = gpu::GpuImage(device, footprint_table_shape(), "footprint table");
    upload_image(commands, device, targets.footprint_table, kept_footprint_table(depth).texels().data(),
                 sizeof(std::uint16_t));
    targets.table_depth = depth;
}

void RendererState::provide_layers(FramePlan& plan_in_use) {
    auto& p = plan_in_use.params;
    const auto layers = static_cast<int>(p.sheets_per_group);
    for (gpu::Buffer* unused :
         {&targets.tile_rects, &targets.sheet_pairs, &targets.sheet_starts, &targets.chunks, &targets.tile_counters,
          &targets.tile_ranges, &targets.tile_order, &targets.tile_entries, &targets.tile_marks, &targets.tile_closed,
          &targets.tile_todo, &targets.tile_pixels, &targets.tiles_seen, &targets.tile_finest, &targets.tile_sheets,
          &targets.outlines})
        *unused = {};
    targets.prepared = {};
    constexpr vk::Format kSums = vk::Format::eR32G32B32A32Sfloat;
    if (!has_shape(targets.sheets, kSums, p.size, layers) ||
        !has_shape(targets.depth, vk::Format::eD16Unorm, p.size, layers) ||
        !has_shape(targets.accumulated, kSums, p.size, 1)) {
        targets.sheets = {};
        targets.depth = {};
        targets.accumulated = {};
        const glm::ivec3 size(p.size, 1);
        targets.sheets = gpu::GpuImage(device,
                                       {.format = kSums,
                                        .size = size,
                                        .layers = layers,
                                        .array = true,
                                        .usage = Usage::eColorAttachment | Usage::eSampled | Usage::eTransferSrc},
                                       "sheet group");
        targets.depth = gpu::GpuImage(device,
                                      {.format = vk::Format::eD16Unorm,
                                       .size = size,
                                       .layers = layers,
                                       .array = true,
                                       .usage = Usage::eDepthStencilAttachment},
                                      "sheet depth");
        targets.accumulated = gpu::GpuImage(
            device,
            {.format = kSums,
             .size = size,
             .usage = Usage::eColorAttachment | Usage::eSampled | Usage::eTransferSrc | Usage::eTransferDst},
            "accumulated picture");
        commands.run([&] { commands.prepare({&targets.sheets, &targets.depth, &targets.accumulated}); });
    }
    grow(device, targets.groups, p.group_count * sizeof(shader::SheetGroup), Place::Host, "sheet groups");
    grow(device, targets.draws, p.group_count * sizeof(shader::DrawCommand), Place::Device, "draw commands");
    p.groups = targets.groups.address();
    p.draws = targets.draws.address();
    const shader::SheetGroup empty{0, 0, {0, 0}, {p.size, 0, 0}};
    std::ranges::fill(targets.groups.mapped<shader::SheetGroup>(p.group_count), empty);
}

void RendererState::provide_tiles(FramePlan& plan_in_use) {
    auto& p = plan_in_use.params;
    for (gpu::GpuImage* unused : {&targets.sheets, &targets.depth, &targets.accumulated})
        *unused = {};
    targets.groups = {};
    targets.draws = {};
    const auto tiles = static_cast<std::size_t>(p.tiles.x) * static_cast<std::size_t>(p.tiles.y);
    grow(device, targets.tile_rects, p.splat_count * 2 * kWord, Place::Device, "tiles of splats");
    grow(device, targets.sheet_pairs, p.sheet_count * kWord, Place::Shared, "pairs of sheets");
    grow(device, targets.sheet_starts, (std::size_t{p.sheet_count} + 1) * kWord, Place::Shared, "sheet starts");
    grow(device, targets.chunks, p.sheet_count * 2 * kWord, Place::Shared, "chunks of sheets");
    p.tile_blocks = tile_blocks(p.tiles, device.profile());
    grow(device, targets.tile_counters, tile_counter_bytes(p.tiles, p.tile_blocks), Place::Device, "tile counters",
         vk::Format::eR32Uint);
    // The host sees which tiles a round is for.
    grow(device, targets.tile_ranges, tiles * 2 * kWord, Place::Shared, "tile ranges", vk::Format::eR32G32Uint);
    grow(device, targets.tile_order, tile_order_items(plan_in_use) * kWord, Place::Host, "tile order",
         vk::Format::eR32Uint);
    grow(device, targets.tile_entries, tile_entry_pairs(plan_in_use, device.profile()) * 2 * kWord, Place::Device,
         "tile entries", vk::Format::eR32G32Uint);
    grow(device, targets.tile_marks, tile_mark_words(plan_in_use, chunk_pairs(p.tiles, device.profile())) * kWord,
         Place::Device, "marks of tile entries", vk::Format::eR32Uint);
    grow(device, targets.tile_closed, tiles * kWord, Place::Device, "closed pixels of tiles", vk::Format::eR32Uint);
    grow(device, targets.tile_todo, tiles * kWord, Place::Shared, "pixels to draw of tiles", vk::Format::eR32Uint);
    if (plan_in_use.refined) {
        grow(device, targets.tile_pixels, tiles * shader::TILE * shader::TILE * kWord, Place::Device, "lists of pixels",
             vk::Format::eR32Uint);
        grow(device, targets.tiles_seen, tiles * kWord, Place::Host, "closed pixels, seen");
        grow(device, targets.tile_finest, tiles * kWord, Place::Device, "finest splats of tiles");
    } else if (!plan_in_use.may_refine) {
        targets.tile_finest = {};
        targets.tiles_seen = {};
        targets.tile_pixels = {};
    }
    grow(device, targets.tile_sheets, picture_bytes(plan_in_use), Place::Device, "unfinished sheets",
         vk::Format::eR32G32B32A32Sfloat);
    if (plan_in_use.variant.outlines)
        grow(device, targets.outlines, picture_bytes(plan_in_use) / sizeof(glm::vec4) * kWord, Place::Device,
             "outlines", vk::Format::eR32Uint);
    else
        targets.outlines = {};
    const std::uint32_t slots = passes::prepared_slots(std::uint64_t{p.splat_count} * plan_in_use.sheets_per_splat);
    const gpu::ImageShape records = passes::prepared_shape(plan_in_use.variant, slots);
    if (!targets.prepared || targets.prepared.shape().size.y < records.size.y) {
        targets.prepared = {};
        targets.prepared = gpu::GpuImage(device, records, "prepared splats");
        commands.run([&] { commands.prepare({&targets.prepared}); });
    }
    p.prepared_mask = slots - 1;
    p.tile_rects = targets.tile_rects.address();
    p.sheet_pairs = targets.sheet_pairs.address();
    p.sheet_starts = targets.sheet_starts.address();
    p.chunks = targets.chunks.address();
    p.tile_closed = targets.tile_closed.address();
    p.tile_todo = targets.tile_todo.address();
    p.tile_finest = targets.tile_finest ? targets.tile_finest.address() : 0;
    p.tile_ranges = targets.tile_ranges.address();
    p.tile_order = targets.tile_order.address();
    p.tile_pixels = targets.tile_pixels ? targets.tile_pixels.address() : 0;
    p.tile_sheets = targets.tile_sheets.address();
    p.outlines = targets.outlines ? targets.outlines.address() : 0;
    place_lists(p);
}

void RendererState::place_lists(shader::FrameParams& p) const {
    p.tile_counters = targets.tile_counters.address();
    p.tile_entries = targets.tile_entries.address();
    p.tile_marks = targets.tile_marks.address();
}

void RendererState::provide_chunks(const Chunks& chunks) {
    auto& p = targets.frame.mapped<shader::FrameParams>(1)[0];
    const std::uint64_t room = padded_pairs(chunks.most_pairs, p.tiles);
    grow(device, targets.tile_entries, room * 2 * kWord, Place::Device, "tile entries", vk::Format::eR32G32Uint);
    grow(device, targets.tile_marks, tile_mark_words(plan, chunks.most_pairs) * kWord, Place::Device,
         "marks of tile entries", vk::Format::eR32Uint);
    const auto tiles = static_cast<std::size_t>(p.tiles.x) * static_cast<std::size_t>(p.tiles.y);
    const auto blocks = static_cast<std::uint32_t>(chunks.most_pairs / shader::BLOCK_PAIRS + 1);
    if (!device.profile().side_by_side && blocks > p.tile_blocks) {
        if (blocks * tiles > kMostTileCounters) {
            fail(
                "a sheet of this view has {} pairs of splat and tile, more than can be sorted: choose a smaller "
                "--sheet-spacing, or --sheet-format layers",
                chunks.most_pairs);
        }
        plan.params.tile_blocks = p.tile_blocks = blocks;
    }
    grow(device, targets.tile_counters, tile_counter_bytes(p.tiles, p.tile_blocks), Place::Device, "tile counters",
         vk::Format::eR32Uint);
    place_lists(p);
    p.entries_first = 0;
    bindings.write(volume_resources, targets);
    std::ranges::copy(chunks.parts, targets.chunks.mapped<glm::uvec2>(chunks.parts.size()).begin());
}

}  // namespace edgesplat

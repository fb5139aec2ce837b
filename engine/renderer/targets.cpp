// RendererState: what a picture is drawn into.
#include <algorithm>

#include "engine/compositors/tiles/chunks.h"
#include "engine/error.h"
#include "engine/passes/4_prepare_splats.h"
#include "engine/plan/resource_table.h"
#include "engine/renderer/state.h"
#include "footprints/face.h"
#include "footprints/footprint_table.h"

namespace edgesplat {
namespace {

constexpr std::size_t kWord = sizeof(std::uint32_t);

/// Makes it at least `bytes` long; what it held is lost if it grows.
void grow(const gpu::Device& device, const TargetBufferRow& row, TargetResources& targets, std::size_t bytes) {
    gpu::Buffer& buffer = targets.*row.buffer;
    if (buffer && buffer.bytes() >= bytes) return;
    buffer = {};
    buffer = gpu::Buffer(device, bytes, row.place, row.text.name, row.texels);
}

bool serves(const gpu::GpuImage& image, const glm::ivec3& size, bool higher_serves) {
    if (!image) return false;
    const gpu::ImageShape& shape = image.shape();
    const bool as_high = higher_serves ? shape.size.y >= size.y : shape.size.y == size.y;
    return shape.size.x == size.x && as_high && shape.layers >= size.z;
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
    const gpu::DeviceProfile& profile = device.profile();
    // What pictures of this plan do without goes before anything new comes.
    for (const TargetBufferRow& row : target_buffer_rows())
        if (row.bytes(plan_in_use, profile) == 0) targets.*row.buffer = {};
    for (const TargetImageRow& row : target_image_rows()) {
        const auto size = row.size(plan_in_use);
        if (!size || !serves(targets.*row.image, *size, row.higher_serves)) targets.*row.image = {};
    }
    std::vector<const gpu::GpuImage*> fresh;
    for (const TargetImageRow& row : target_image_rows()) {
        gpu::GpuImage& image = targets.*row.image;
        const auto size = row.size(plan_in_use);
        if (!size || image) continue;
        image = gpu::GpuImage(device, shape_of(row, *size), row.text.name);
        fresh.push_back(&image);
    }
    if (std::ranges::find(fresh, &targets.footprint_table) != fresh.end()) targets.table_depth = 0;
    if (!fresh.empty())
        commands.run([&] {
            for (const gpu::GpuImage* image : fresh)
                commands.prepare({image});
        });
    if (targets.footprint_table) fill_table(p.face_depth);
    p.tile_blocks = tile_blocks(p.tiles, profile);
    p.prepared_mask = passes::prepared_slots(std::uint64_t{p.splat_count} * plan_in_use.sheets_per_splat) - 1;
    for (const TargetBufferRow& row : target_buffer_rows()) {
        const std::uint64_t bytes = row.bytes(plan_in_use, profile);
        if (bytes > 0) grow(device, row, targets, bytes);
        if (row.address) p.*row.address = bytes > 0 ? (targets.*row.buffer).address() : 0;
    }
    const auto place = [&](const gpu::Buffer& buffer) { return buffer ? buffer.address() : shader::Address(); };
    for (const SplatListRow& row : splat_list_rows())
        p.*row.drawn = place(volume_resources.*row.list);
    for (const LightListRow& row : light_list_rows())
        p.*row.drawn = place(volume_resources.*row.list);
    p.transfer = place(volume_resources.transfer);
    std::ranges::copy(plan_in_use.batches, targets.batches.mapped<glm::uvec2>(plan_in_use.batches.size()).begin());
    if (!plan_in_use.variant.tiles) {
        const shader::SheetGroup empty{0, 0, {0, 0}, {p.size, 0, 0}};
        std::ranges::fill(targets.groups.mapped<shader::SheetGroup>(p.group_count), empty);
    }
    targets.frame.mapped<shader::FrameParams>(1)[0] = p;
    bindings.write(volume_resources, targets);
}

void RendererState::fill_table(float face_depth) {
    const double depth = face_depth > static_cast<float>(kFaceDepth) ? kDeepFaceDepth : kFaceDepth;
    if (targets.table_depth == depth) return;
    targets.table_depth = 0;
    upload_image(commands, device, targets.footprint_table, kept_footprint_table(depth).texels().data(),
                 sizeof(std::uint16_t));
    targets.table_depth = depth;
}

void RendererState::provide_chunks(const Chunks& chunks) {
    auto& p = targets.frame.mapped<shader::FrameParams>(1)[0];
    const auto grow_to = [&](gpu::Buffer TargetResources::*buffer, std::uint64_t bytes) {
        const TargetBufferRow& row = row_of(buffer);
        grow(device, row, targets, bytes);
        p.*row.address = (targets.*buffer).address();
    };
    grow_to(&TargetResources::tile_entries, padded_pairs(chunks.most_pairs, p.tiles) * 2 * kWord);
    grow_to(&TargetResources::tile_marks, tile_mark_words(plan, chunks.most_pairs) * kWord);
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
    grow_to(&TargetResources::tile_counters, tile_counter_bytes(p.tiles, p.tile_blocks));
    p.entries_first = 0;
    bindings.write(volume_resources, targets);
    std::ranges::copy(chunks.parts, targets.chunks.mapped<glm::uvec2>(chunks.parts.size()).begin());
}

}  // namespace edgesplat

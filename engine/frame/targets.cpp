#include "engine/frame/targets.h"

#include <algorithm>

#include "engine/error.h"
#include "engine/passes/4_prepare_splats.h"
#include "footprints/face.h"
#include "footprints/footprint_table.h"

namespace edgesplat {
namespace {

constexpr std::uint64_t kWord = sizeof(std::uint32_t);

bool serves(const gpu::GpuImage& image, const glm::ivec3& size, bool taller_is_reusable) {
    if (!image) return false;
    const gpu::ImageShape& shape = image.shape();
    const bool as_high = taller_is_reusable ? shape.size.y >= size.y : shape.size.y == size.y;
    return shape.size.x == size.x && as_high && shape.layers >= size.z;
}

shader::Address address_of(const gpu::Buffer& buffer) {
    return buffer ? buffer.address() : shader::Address();
}

void point_to(shader::VolumeParams& volume, const SplatLists& splats) {
    for (const SplatListRow& row : splat_list_rows())
        volume.*row.drawn = address_of(splats.*row.list);
    for (const LightListRow& row : light_list_rows())
        volume.*row.drawn = address_of(splats.*row.list);
    volume.transfer = address_of(splats.transfer);
}

}  // namespace

Targets::Targets(DeviceSession& session) : session_(&session) {
    for (const TargetBufferRow& row : target_buffer_rows())
        if (row.always) grow(row, row.bytes({}, session.profile()));
    const std::vector<std::uint32_t> indices = passes::quad_indices();
    std::ranges::copy(indices, resources_.indices.mapped<std::uint32_t>(indices.size()).begin());
    session.bindings().write_targets(resources_);
}

void Targets::drop() {
    TargetResources kept;
    for (const TargetBufferRow& row : target_buffer_rows())
        if (row.always) kept.*row.buffer = std::move(resources_.*row.buffer);
    resources_ = std::move(kept);
    session_->bindings().write_targets(resources_);
}

std::span<glm::vec4> Targets::pixels(const FramePlan& plan) const {
    return resources_.output.mapped<glm::vec4>(picture_bytes(plan) / sizeof(glm::vec4));
}

void Targets::grow(const TargetBufferRow& row, std::uint64_t bytes) {
    gpu::Buffer& buffer = resources_.*row.buffer;
    if (buffer && buffer.bytes() >= bytes) return;
    buffer = {};
    buffer = gpu::Buffer(session_->device(), bytes, row.place, row.text.name, row.texels);
}

void Targets::provide_images(const FramePlan& plan) {
    for (const TargetImageRow& row : target_image_rows()) {
        const auto size = row.size(plan);
        if (!size || !serves(resources_.*row.image, *size, row.taller_is_reusable)) resources_.*row.image = {};
    }
    std::vector<const gpu::GpuImage*> fresh;
    for (const TargetImageRow& row : target_image_rows()) {
        gpu::GpuImage& image = resources_.*row.image;
        const auto size = row.size(plan);
        if (!size || image) continue;
        image = gpu::GpuImage(session_->device(), row.shape(*size), row.text.name);
        fresh.push_back(&image);
    }
    if (fresh.empty()) return;
    if (std::ranges::find(fresh, &resources_.footprint_table) != fresh.end()) table_depth_ = -1;
    session_->commands().run([&] {
        for (const gpu::GpuImage* image : fresh)
            session_->commands().prepare({image});
    });
}

void Targets::provide(FramePlan& plan, std::span<const CollectedSplats> splats, std::span<const FramePlan> beside) {
    auto& p = plan.params;
    const gpu::DeviceProfile& profile = session_->profile();
    // Free what this plan does not need before allocating.
    for (const TargetBufferRow& row : target_buffer_rows()) {
        const auto needs = [&](const FramePlan& part) { return row.bytes(part, profile) > 0; };
        if (!needs(plan) && std::ranges::none_of(beside, needs)) resources_.*row.buffer = {};
    }
    provide_images(plan);
    if (resources_.footprint_table) fill_table(plan.volume.table_depth > 0 ? FACE_DEPTH : 0);
    p.tile_blocks = tile_blocks(p.tiles, profile);
    p.chunk_pairs = static_cast<std::uint32_t>(chunk_pairs(p.tiles, profile));
    p.prepared_mask = passes::prepared_slots(std::uint64_t{p.splat_count} * plan.sheets_per_splat) - 1;
    for (const TargetBufferRow& row : target_buffer_rows()) {
        if (const std::uint64_t bytes = row.bytes(plan, profile); bytes > 0) grow(row, bytes);
        if (row.address) p.*row.address = address_of(resources_.*row.buffer);
    }
    std::ranges::copy(plan.batches, resources_.batches.mapped<glm::uvec2>(plan.batches.size()).begin());
    if (resources_.label_colors)
        std::ranges::copy(plan.label_colors,
                          resources_.label_colors.mapped<glm::vec3>(plan.label_colors.size()).begin());
    if (!plan.variant.tiles) {
        const shader::SheetGroup empty{0, 0, {0, 0}, {p.size, 0, 0}};
        std::ranges::fill(resources_.groups.mapped<shader::SheetGroup>(p.group_count), empty);
    }
    block().frame = p;
    for (std::size_t k = 0; k < splats.size(); ++k) {
        shader::VolumeParams& volume = k == 0 ? plan.volume : plan.together[k - 1];
        point_to(volume, splats[k].splats.lists());
        block().volumes[k] = volume;
    }
    session_->bindings().write_targets(resources_);
}

void Targets::fill_table(double depth) {
    if (table_depth_ == depth) return;
    upload_image(session_->commands(), session_->device(), resources_.footprint_table,
                 kept_footprint_table(depth).texels().data(), sizeof(std::uint16_t));
    table_depth_ = depth;
}

void Targets::provide_chunks(FramePlan& plan, const Chunks& chunks) {
    auto& p = block().frame;
    const auto grow_to = [&](gpu::Buffer TargetResources::*buffer, std::uint64_t bytes) {
        const TargetBufferRow& row = row_of(buffer);
        grow(row, bytes);
        p.*row.address = (resources_.*buffer).address();
    };
    grow_to(&TargetResources::tile_entries, padded_pairs(chunks.most_pairs, p.tiles) * 2 * kWord);
    grow_to(&TargetResources::tile_marks, tile_mark_words(plan, chunks.most_pairs) * kWord);
    if (plan.variant.traced)
        grow_to(&TargetResources::traced_entries, traced_words(plan, padded_pairs(chunks.most_pairs, p.tiles)) * kWord);
    const auto blocks = static_cast<std::uint32_t>(chunks.most_pairs / shader::BLOCK_PAIRS + 1);
    if (!session_->profile().side_by_side && blocks > p.tile_blocks) {
        if (blocks * tile_count(plan) > kMostTileCounters) {
            fail(
                "a sheet of this view has {} pairs of splat and tile, more than can be sorted: choose a smaller "
                "--sheet-spacing, or --sheet-format layers",
                chunks.most_pairs);
        }
        plan.params.tile_blocks = p.tile_blocks = blocks;
    }
    grow_to(&TargetResources::tile_counters, tile_counter_bytes(p.tiles, p.tile_blocks));
    p.entries_first = 0;
    session_->bindings().write_targets(resources_);
    std::ranges::copy(chunks.parts, resources_.chunks.mapped<glm::uvec2>(chunks.parts.size()).begin());
}

}  // namespace edgesplat

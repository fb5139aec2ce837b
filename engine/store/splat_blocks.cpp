// SplatStore: a list of splats that blocks are added to and dropped from.
#include <algorithm>

#include "engine/plan/resource_table.h"
#include "engine/store/blocks.h"
#include "engine/store/splat_store.h"
#include "engine/volume/filters.h"

namespace edgesplat {
namespace {

/// Samples of a block, scaled as `scaled_field` scales them.
std::vector<float> scaled_block(const SampleSource& source, const Volume& volume, const CollectionBlock& block) {
    const glm::u64vec3 size(block.size);
    std::vector<float> samples(size.x * size.y * size.z);
    source.read(block.low, block.size, samples);
    for (float& sample : samples)
        sample = scaled_sample(volume, sample);
    return samples;
}

}  // namespace

void SplatStore::begin_blocks(VolumeStore& volume, std::shared_ptr<const SampleSource> source,
                              const CollectionPlan& wanted) {
    collected_.reset();
    residence_.emplace();
    residence_->source = std::move(source);
    residence_->blocks = blocks_with_splats(*residence_->source, *volume.volume(), wanted);
    residence_->held.resize(residence_->blocks.size());
    const CollectionBlock largest = largest_block(wanted.dims);
    volume.hold_blocks(largest.size, wanted.takes_coefficients(), wanted.labels != 0);
    session_->bindings().write_volume(volume.images());
    prepare(wanted, largest);
    collected_ = wanted;
}

std::uint64_t SplatStore::blocks_held() const {
    return static_cast<std::uint64_t>(std::ranges::count_if(residence_->held, [](const auto& b) { return bool(b); }));
}

std::vector<float> SplatStore::read_block(const VolumeStore& volume, std::size_t block,
                                          std::optional<std::size_t> after) {
    auto& r = *residence_;
    const auto begin = [&](std::size_t wanted) {
        r.being_read = wanted;
        r.samples =
            std::async(std::launch::async, [source = r.source, scaling = volume.volume(), part = r.blocks[wanted]] {
                return scaled_block(*source, *scaling, part);
            });
    };
    if (!r.samples.valid() || r.being_read != block) begin(block);
    std::vector<float> samples = r.samples.get();
    // Read the next block while the device processes this one.
    if (after) begin(*after);
    return samples;
}

bool SplatStore::add_block(VolumeStore& volume, std::size_t block, std::optional<std::size_t> after,
                           std::span<const std::size_t> needed, std::uint64_t most_splats, SetupCost& cost) {
    volume.load(residence_->blocks[block], read_block(volume, block, after));
    auto& held = residence_->held[block];
    const auto collect = [&] {
        return collect_block(*collected_, residence_->blocks[block], false, most_splats, cost);
    };
    held = collect();
    if (!held && drop_blocks(needed, false)) held = collect();
    return held.has_value();
}

bool SplatStore::drop_blocks(std::span<const std::size_t> needed, bool shrink) {
    std::vector<std::size_t> kept;
    for (std::size_t i = 0; i < residence_->held.size(); ++i) {
        auto& held = residence_->held[i];
        if (!held) continue;
        if (std::ranges::binary_search(needed, i))
            kept.push_back(i);
        else
            held.reset();
    }
    std::ranges::sort(kept, {}, [&](std::size_t i) { return residence_->held[i]->first; });
    std::uint64_t count = 0;
    for (const std::size_t i : kept)
        count += residence_->held[i]->count;
    if (count == lists_.splat_count && !shrink) return false;
    // Each list is copied to a new one that has only the kept parts, without gaps.
    gpu::Commands& commands = session_->commands();
    auto& params = lists_.scene.mapped<shader::SceneParams>(1)[0];
    for (const SplatListRow& row : splat_list_rows()) {
        gpu::Buffer& list = lists_.*row.list;
        if (!list) continue;
        const std::uint64_t bytes = row.bytes(*collected_);
        gpu::Buffer compacted(session_->device(), std::max<std::uint64_t>(count, 1) * bytes, gpu::Buffer::Place::Device,
                              row.text.name);
        std::vector<vk::BufferCopy> parts;
        std::uint64_t to = 0;
        for (const std::size_t i : kept) {
            const CollectedBlock& part = *residence_->held[i];
            if (part.count > 0) parts.emplace_back(part.first * bytes, to * bytes, part.count * bytes);
            to += part.count;
        }
        if (!parts.empty()) {
            commands.run([&] {
                commands.copy(list, compacted, parts);
                commands.barrier();
            });
        }
        list = std::move(compacted);
        params.*row.collected = list.address();
    }
    lists_.splat_count = lists_.edge_splat_count = lists_.crease_splat_count = 0;
    for (const std::size_t i : kept) {
        CollectedBlock& part = *residence_->held[i];
        part.first = lists_.splat_count;
        lists_.splat_count += part.count;
        lists_.edge_splat_count += part.with_edge;
        lists_.crease_splat_count += part.with_crease;
    }
    index_blocks();
    return true;
}

void SplatStore::bound_blocks(const VolumeStore& volume) {
    lists_.box_low = volume.volume()->geometry.dims - 1;
    lists_.box_high = glm::ivec3(0);
    for (const auto& held : residence_->held) {
        if (!held || held->count == 0) continue;
        lists_.box_low = glm::min(lists_.box_low, held->low);
        lists_.box_high = glm::max(lists_.box_high, held->high);
    }
    if (lists_.splat_count == 0) std::swap(lists_.box_low, lists_.box_high);
    index_blocks();
}

void SplatStore::index_blocks() {
    std::vector<const CollectedBlock*> held;
    for (const auto& block : residence_->held)
        if (block) held.push_back(&*block);
    std::ranges::sort(held, {}, [](const CollectedBlock* block) { return block->first; });
    std::vector<SplatBrick> bricks;
    for (const CollectedBlock* block : held)
        for (SplatBrick brick : block->bricks) {
            brick.first += static_cast<std::uint32_t>(block->first);
            bricks.push_back(brick);
        }
    lists_.bricks.assign(std::move(bricks));
}

}  // namespace edgesplat

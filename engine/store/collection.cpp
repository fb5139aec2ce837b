#include "engine/store/collection.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "engine/error.h"
#include "engine/plan/resource_table.h"

namespace edgesplat {
namespace {

using Place = gpu::Buffer::Place;

// A splat's number is multiplied by its size in 32 bits.
constexpr std::uint64_t kMostSplats = std::numeric_limits<std::uint32_t>::max() / sizeof(shader::Splat);

/// Slices' counts to places in the list; notes the bricks, and the box of what holds splats.
void scan_runs(const CollectionBlock& block, VolumeResources& resources, CollectedBlock& collected) {
    const BrickRuns runs(block.core_size);
    const auto offsets = resources.run_offsets.mapped<std::uint32_t>(runs.count());
    std::uint64_t total = resources.splat_count;
    collected.first = total;
    VoxelBox box;
    runs.each_brick([&](const VoxelBox& voxels, std::uint64_t run, std::uint64_t stride) {
        SplatBrick brick{{}, static_cast<std::uint32_t>(total - collected.first), 0};
        for (int z = voxels.low.z; z <= voxels.high.z; ++z, run += stride) {
            const std::uint32_t count = std::exchange(offsets[run], static_cast<std::uint32_t>(total));
            total += count;
            brick.count += count;
            if (count > 0) brick.box.add(voxels.slice(z));
        }
        if (brick.count == 0) return;
        box.add(brick.box);
        brick.box.low += block.core_low;
        brick.box.high += block.core_low;
        collected.bricks.push_back(brick);
    });
    collected.count = total - resources.splat_count;
    if (box.empty()) box = {glm::ivec3(0), block.core_size - 1};
    collected.low = block.core_low + box.low;
    collected.high = block.core_low + box.high;
}

/// The planes of the scene, counted from a block's first voxel.
void place_planes(glm::vec4 (&planes)[shader::MAX_CLIP_PLANES], const glm::ivec3& low) {
    for (glm::vec4& plane : planes)
        plane.w += glm::dot(glm::vec3(plane), glm::vec3(low));
}

/// Makes a list of the splats `bytes` long; what is in it stays.
void lengthen(const gpu::Device& device, gpu::Commands& commands, gpu::Buffer& list, std::size_t bytes,
              std::size_t used, const char* name) {
    gpu::Buffer longer(device, bytes, Place::Device, name);
    if (used > 0) {
        commands.run([&] {
            commands.copy(list, longer, {{0, 0, used}});
            commands.barrier();
        });
    }
    list = std::move(longer);
}

/// Room for `count` splats in all.
void reserve(const gpu::Device& device, gpu::Commands& commands, const CollectionPlan& plan, std::uint64_t count,
             VolumeResources& resources) {
    auto& params = resources.scene.mapped<shader::SceneParams>(1)[0];
    for (const SplatListRow& row : splat_list_rows()) {
        const std::uint64_t bytes = row.bytes(plan);
        if (bytes == 0) continue;
        gpu::Buffer& list = resources.*row.list;
        lengthen(device, commands, list, count * bytes, resources.splat_count * bytes, row.text.name);
        params.*row.collected = list.address();
    }
}

}  // namespace

CollectionBlock whole_block(const glm::ivec3& dims) {
    return {glm::ivec3(0), dims, glm::ivec3(0), dims};
}

passes::EstimateEdges estimate_inputs(const CollectionPlan& plan) {
    return {plan.estimator, plan.skip_buried, plan.params.iso_count};
}

passes::CollectSplats collect_inputs(const CollectionPlan& plan) {
    return {.core_size = plan.dims,
            .iso_count = plan.params.iso_count,
            .edges = plan.edge_field,
            .buried = plan.buried,
            .faces = plan.faces,
            .clip = plan.clip,
            .transfer = !plan.transfer.empty()};
}

void prepare_collection(const gpu::Device& device, gpu::Commands& commands, Bindings& bindings,
                        const CollectionPlan& plan, const CollectionBlock& largest, VolumeResources& resources) {
    // What a change of the scene replaces is not held next to its successor.
    for (const SplatListRow& row : splat_list_rows())
        resources.*row.list = {};
    for (const CollectionBufferRow& row : collection_buffer_rows())
        resources.*row.buffer = {};
    resources.edges = {};
    resources.buried = {};
    resources.splat_count = resources.edge_splat_count = resources.crease_splat_count = 0;
    resources.bricks.clear();
    std::vector<const gpu::GpuImage*> fresh;
    for (const VolumeImageRow& row : volume_image_rows()) {
        gpu::GpuImage& image = resources.*row.image;
        if (image || !row.held(plan)) continue;
        image = gpu::GpuImage(device, shape_of(row, largest.size), row.text.name);
        fresh.push_back(&image);
    }
    for (const CollectionBufferRow& row : collection_buffer_rows())
        if (const std::uint64_t bytes = row.bytes(plan, largest.core_size); bytes > 0)
            resources.*row.buffer = gpu::Buffer(device, bytes, Place::Host, row.text.name);
    resources.scene.mapped<shader::SceneParams>(1)[0] = plan.params;
    if (resources.transfer)
        std::ranges::copy(plan.transfer, resources.transfer.mapped<shader::TransferRow>(plan.transfer.size()).begin());
    bindings.write(resources, {});
    commands.run([&] {
        for (const gpu::GpuImage* image : fresh)
            commands.prepare({image});
    });
}

namespace {

/// Points the passes at a block. What is known of the lists stays.
void place_block(const CollectionPlan& plan, const CollectionBlock& block, VolumeResources& resources) {
    auto& params = resources.scene.mapped<shader::SceneParams>(1)[0];
    const shader::SceneParams lists = params;
    params = plan.params;
    params.dims = block.size;
    params.core_low = block.core_low - block.low;
    params.core_size = block.core_size;
    params.block_origin = block.low;
    params.volume_dims = plan.dims;
    place_planes(params.clip_keep, block.low);
    place_planes(params.clip_remove, block.low);
    params.run_offsets = resources.run_offsets.address();
    for (const SplatListRow& row : splat_list_rows())
        params.*row.collected = lists.*row.collected;
    if (resources.transfer) params.transfer = resources.transfer.address();
}

void mark_block(gpu::Commands& commands, const CollectionPlan& plan, const CollectionBlock& block) {
    if (!plan.buried) return;
    commands.span("1a_mark_buried",
                  [&] { passes::mark_buried(commands, block.size, plan.params.iso_count, plan.clip); });
}

void count_block(gpu::Commands& commands, const passes::CollectSplats& collect) {
    commands.span("2_collect_splats", [&] { passes::count_splats(commands, collect); });
}

/// After its edges were found and its splats counted: the block's splats, behind those in the list.
std::optional<CollectedBlock> list_block(const gpu::Device& device, gpu::Commands& commands, const CollectionPlan& plan,
                                         const CollectionBlock& block, bool exact, std::uint64_t most_splats,
                                         VolumeResources& resources) {
    passes::CollectSplats collect = collect_inputs(plan);
    collect.core_size = block.core_size;
    CollectedBlock out;
    scan_runs(block, resources, out);
    const std::uint64_t total = out.first + out.count;
    if (total > most_splats) return std::nullopt;
    if (total > kMostSplats) fail("{} voxels can be seen at once; the splat list holds {}", total, kMostSplats);
    const std::uint64_t room = resources.splats ? resources.splats.bytes() / sizeof(shader::Splat) : 0;
    if (exact || total > room)
        reserve(device, commands, plan, exact ? total : std::min(std::max(total, 2 * room), most_splats), resources);
    // Behind the runs' offsets two more words.
    const std::uint64_t runs = passes::collect_runs(block.core_size);
    const std::span<std::uint32_t> counts = resources.run_offsets.mapped<std::uint32_t>(runs + 2).subspan(runs);
    std::ranges::fill(counts, 0U);
    auto& params = resources.scene.mapped<shader::SceneParams>(1)[0];
    params.list_first = static_cast<std::uint32_t>(out.first);
    params.list_count = static_cast<std::uint32_t>(out.count);
    params.edge_count_at = static_cast<std::uint32_t>(runs);
    commands.run(
        [&] { commands.span("2_collect_splats", [&] { passes::write_splats(commands, collect, out.count); }); });
    out.with_edge = counts[0];
    out.with_crease = counts[1];
    out.times = commands.span_times();
    resources.splat_count = total;
    resources.edge_splat_count += out.with_edge;
    resources.crease_splat_count += out.with_crease;
    return out;
}

/// The list is of this block alone.
void hold_list(CollectedBlock& collected, VolumeResources& resources) {
    resources.box_low = collected.low;
    resources.box_high = collected.high;
    resources.bricks.assign(std::move(collected.bricks));
}

}  // namespace

std::optional<CollectedBlock> collect_block(const gpu::Device& device, gpu::Commands& commands,
                                            const CollectionPlan& plan, const CollectionBlock& block, bool exact,
                                            std::uint64_t most_splats, VolumeResources& resources) {
    passes::CollectSplats collect = collect_inputs(plan);
    collect.core_size = block.core_size;
    place_block(plan, block, resources);
    commands.run([&] {
        mark_block(commands, plan, block);
        if (plan.edge_field) {
            const passes::EdgeRegion region{block.size, block.core_low - block.low, block.core_size};
            commands.span("1_estimate_edges", [&] { passes::estimate_edges(commands, region, estimate_inputs(plan)); });
        }
        count_block(commands, collect);
    });
    std::vector<PassTime> times = commands.span_times();
    auto out = list_block(device, commands, plan, block, exact, most_splats, resources);
    if (!out) return std::nullopt;
    add_times(times, out->times);
    out->times = std::move(times);
    return out;
}

std::uint64_t voxels_that_depend_on(const VoxelBox& changed, const glm::ivec3& dims) {
    const VoxelBox reached = changed.widened(shader::CHANGE_MARGIN);
    return VoxelBox{glm::max(reached.low, 0), glm::min(reached.high, dims - 1)}.count();
}

std::vector<PassTime> renew_collection(const gpu::Device& device, gpu::Commands& commands, Bindings& bindings,
                                       const CollectionPlan& plan, const VoxelBox& changed,
                                       VolumeResources& resources) {
    const CollectionBlock whole = whole_block(plan.dims);
    resources.splat_count = resources.edge_splat_count = resources.crease_splat_count = 0;
    resources.bricks.clear();
    bindings.write(resources, {});
    place_block(plan, whole, resources);
    auto& params = resources.scene.mapped<shader::SceneParams>(1)[0];
    std::vector<PassTime> times;
    const auto run = [&](const auto& body) {
        commands.run(body);
        add_times(times, commands.span_times());
    };
    run([&] { mark_block(commands, plan, whole); });
    if (plan.edge_field) {
        // The pass goes as far beyond the core as it does in a block.
        const VoxelBox core = changed.widened(shader::CHANGE_MARGIN - shader::ESTIMATE_MARGIN);
        params.core_low = core.low;
        params.core_size = core.size();
        const passes::EdgeRegion region{plan.dims, params.core_low, params.core_size};
        run([&] {
            commands.span("1_estimate_edges", [&] { passes::estimate_edges(commands, region, estimate_inputs(plan)); });
        });
    }
    place_block(plan, whole, resources);
    run([&] { count_block(commands, collect_inputs(plan)); });
    auto collected = list_block(device, commands, plan, whole, true, kMostSplats, resources);
    add_times(times, collected->times);
    hold_list(*collected, resources);
    return times;
}

std::vector<PassTime> run_collection(const gpu::Device& device, gpu::Commands& commands, Bindings& bindings,
                                     const CollectionPlan& plan, VolumeResources& resources) {
    const CollectionBlock whole = whole_block(plan.dims);
    prepare_collection(device, commands, bindings, plan, whole, resources);
    auto collected = collect_block(device, commands, plan, whole, true, kMostSplats, resources);
    hold_list(*collected, resources);
    return collected->times;
}

}  // namespace edgesplat

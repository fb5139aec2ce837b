#include "engine/store/splat_store.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "engine/error.h"
#include "engine/gpu/read_back.h"
#include "engine/plan/resource_table.h"

namespace edgesplat {
namespace {

using Place = gpu::Buffer::Place;

constexpr std::uint64_t kFinishedAtOnce = std::uint64_t{1} << 18U;  // splats; a second on a slow processor
constexpr std::uint64_t kCopiedAtOnce = std::uint64_t{4} << 20U;    // bytes of a kept list
// Shaders compute number * size of a splat in 32 bits.
constexpr std::uint64_t kMostSplats = std::numeric_limits<std::uint32_t>::max() / sizeof(shader::Splat);

/// Makes clip planes relative to a block's first voxel.
void place_planes(glm::vec4 (&planes)[shader::MAX_CLIP_PLANES], const glm::ivec3& low) {
    for (glm::vec4& plane : planes)
        plane.w += glm::dot(glm::vec3(plane), glm::vec3(low));
}

/// Number of voxels whose edges must be estimated again if the samples in a box change.
std::uint64_t voxels_that_depend_on(const VoxelBox& changed, const glm::ivec3& dims) {
    const VoxelBox reached = changed.widened(shader::CHANGE_MARGIN);
    return VoxelBox{glm::max(reached.low, 0), glm::min(reached.high, dims - 1)}.count();
}

}  // namespace

passes::EstimateEdges estimate_inputs(const CollectionPlan& plan) {
    return {plan.estimator, plan.skip_buried, plan.surfaces, plan.params.iso_count};
}

passes::CollectSplats collect_inputs(const CollectionPlan& plan) {
    return {.core_size = plan.dims,
            .iso_count = plan.params.iso_count,
            .edges = plan.edge_field,
            .buried = plan.buried,
            .estimator = plan.estimator,
            .faces = plan.faces,
            .surfaces = plan.surfaces,
            .two_values = plan.two_values,
            .clip = plan.clip,
            .transfer = !plan.transfer.empty(),
            .labels = plan.labels};
}

void SplatStore::drop() {
    lists_ = {};
    collected_.reset();
    residence_.reset();
}

void SplatStore::bind(const VolumeStore& volume) const {
    session_->bindings().write_volume(volume.images());
    session_->bindings().write_splats(lists_);
}

void SplatStore::forget_light() {
    occluded_.reset();
    shadowed_.reset();
}

bool SplatStore::collect(VolumeStore& volume, const CollectionPlan& wanted, SetupCost& cost) {
    const StaleResults stale = collected_ ? stale_results(*collected_, wanted) : StaleResults{};
    if (!stale.lists && stale.transfer) classify(wanted);
    if (!volume.changed() && !stale.lists) return false;
    // The spline's coefficients depend on all samples.
    if (volume.changed() && !stale.lists && !wanted.takes_coefficients() && holds_fields(wanted))
        collect_changes(volume, cost);
    else
        recollect(volume, wanted, volume.changed() || !holds_fields(wanted) ? StaleResults{} : stale, cost);
    return true;
}

void SplatStore::classify(const CollectionPlan& wanted) {
    std::ranges::copy(wanted.transfer, lists_.transfer.mapped<shader::TransferRow>(wanted.transfer.size()).begin());
    collected_->transfer = wanted.transfer;
}

void SplatStore::recollect(VolumeStore& volume, const CollectionPlan& wanted, const StaleResults& stale,
                           SetupCost& cost) {
    collected_.reset();
    forget_light();
    lists_.occlusion = {};
    lists_.shadows = {};
    const CollectionBlock whole = whole_block(wanted.dims);
    const std::string key = cost.kept.empty() ? "" : splats_key(session_->device(), *volume.volume(), wanted);
    auto kept = key.empty() ? std::nullopt : read_splats(cost.kept, key, wanted);
    // Passes that draw read the coefficients only of surface splats.
    if (wanted.takes_coefficients() && (!kept || wanted.surfaces)) volume.provide_coefficients();
    if (wanted.labels != 0) volume.provide_labels();
    session_->bindings().write_volume(volume.images());
    if (kept) {
        take_kept(wanted, std::move(*kept));
        collected_ = wanted;
        cost.read = true;
        return;
    }
    prepare(wanted, whole, stale);
    list_bricks(wanted, volume);
    lists_.border = wanted.surfaces ? faces_with_matter(*volume.volume(), wanted.params) : 0;
    auto list = collect_block(wanted, whole, true, kMostSplats, cost, stale);
    hold_list(*list);
    collected_ = wanted;
    if (!key.empty()) keep_splats(cost.kept, key, kept_list(wanted));
}

bool SplatStore::holds_fields(const CollectionPlan& plan) const {
    return std::ranges::all_of(field_image_rows(),
                               [&](const auto& row) { return !row.held(plan) || lists_.*row.image; });
}

KeptSplats SplatStore::kept_list(const CollectionPlan& plan) const {
    KeptSplats kept{.splats = lists_.splat_count,
                    .with_edge = lists_.edge_splat_count,
                    .with_crease = lists_.crease_splat_count,
                    .traced = lists_.traced_splat_count,
                    .low = lists_.box_low,
                    .high = lists_.box_high,
                    .border = lists_.border,
                    .bricks = {lists_.bricks.bricks().begin(), lists_.bricks.bricks().end()},
                    .lists = {}};
    for (const SplatListRow& row : splat_list_rows()) {
        auto& list = kept.lists.emplace_back(lists_.splat_count * row.bytes(plan));
        for (std::uint64_t done = 0; done < list.size(); done += kCopiedAtOnce) {
            const auto part = gpu::read_back<std::uint8_t>(session_->device(), session_->commands(), lists_.*row.list,
                                                           done, std::min(kCopiedAtOnce, list.size() - done));
            std::ranges::copy(part, list.begin() + static_cast<std::ptrdiff_t>(done));
        }
    }
    return kept;
}

void SplatStore::take_kept(const CollectionPlan& plan, KeptSplats kept) {
    CollectionPlan without_fields = plan;
    without_fields.edge_field = without_fields.buried = false;
    lists_.edges = {};
    lists_.buried = {};
    prepare(without_fields, whole_block(plan.dims));
    place_block(plan, whole_block(plan.dims));
    reserve(plan, kept.splats);
    gpu::Commands& commands = session_->commands();
    const gpu::Buffer staging(session_->device(), kCopiedAtOnce, Place::Host, kStagingBuffer.name);
    for (std::size_t i = 0; i < kept.lists.size(); ++i) {
        const std::span<const std::uint8_t> list = kept.lists[i];
        for (std::uint64_t done = 0; done < list.size(); done += kCopiedAtOnce) {
            const std::uint64_t bytes = std::min(kCopiedAtOnce, list.size() - done);
            std::ranges::copy(list.subspan(done, bytes), staging.mapped<std::uint8_t>(bytes).begin());
            commands.run([&] {
                commands.copy(staging, lists_.*splat_list_rows()[i].list, {{0, done, bytes}});
                commands.barrier();
            });
        }
    }
    lists_.splat_count = kept.splats;
    lists_.edge_splat_count = kept.with_edge;
    lists_.crease_splat_count = kept.with_crease;
    lists_.traced_splat_count = kept.traced;
    lists_.box_low = kept.low;
    lists_.box_high = kept.high;
    lists_.border = kept.border;
    lists_.bricks.assign(std::move(kept.bricks));
}

void SplatStore::collect_changes(VolumeStore& volume, SetupCost& cost) {
    // The list is invalid until the end; an exception leaves it so.
    const CollectionPlan plan = *std::exchange(collected_, std::nullopt);
    const VoxelBox& changed = *volume.changed();
    forget_light();
    lists_.occlusion = {};
    lists_.shadows = {};
    const CollectionBlock whole = whole_block(plan.dims);
    lists_.border = plan.surfaces ? faces_with_matter(*volume.volume(), plan.params) : 0;
    list_bricks(plan, volume);
    clear_counts();
    bind(volume);
    place_block(plan, whole);
    auto& params = lists_.scene.mapped<shader::SceneParams>(1)[0];
    gpu::Commands& commands = session_->commands();
    const auto run = [&](const auto& body) {
        commands.run(body);
        add_times(cost.times, commands.span_times());
    };
    run([&] { mark_block(plan, whole); });
    if (plan.edge_field) {
        // The pass also covers ESTIMATE_MARGIN voxels around the core, as in a block.
        const VoxelBox core = changed.widened(shader::CHANGE_MARGIN - shader::ESTIMATE_MARGIN);
        params.core_low = core.low;
        params.core_size = core.size();
        params.brick_count = 0;
        const passes::EdgeRegion region{plan.dims, params.core_low, params.core_size};
        run([&] { commands.pass(passes::estimate_edges(region, estimate_inputs(plan))); });
        cost.voxels_estimated += voxels_that_depend_on(changed, plan.dims);
    }
    place_block(plan, whole);
    run([&] { count_block(block_inputs(plan, whole)); });
    auto list = list_block(plan, whole, true, kMostSplats, cost);
    hold_list(*list);
    collected_ = plan;
}

void SplatStore::list_bricks(const CollectionPlan& plan, VolumeStore& volume) {
    bricks_listed_ = 0;
    if (!plan.lists_bricks()) return;
    const std::span iso(plan.params.iso, plan.params.iso_count);
    const std::vector<std::uint32_t> bricks = volume.ranges().list(iso, plan.surfaces);
    // Without any, one brick is processed: 0 stands for all.
    bricks_listed_ = std::max(static_cast<std::uint32_t>(bricks.size()), 1U);
    const auto listed = lists_.listed_bricks.mapped<std::uint32_t>(bricks_listed_);
    listed[0] = 0;
    std::ranges::copy(bricks, listed.begin());
}

void SplatStore::clear_counts() {
    lists_.splat_count = lists_.edge_splat_count = lists_.crease_splat_count = lists_.traced_splat_count = 0;
    lists_.bricks.clear();
}

void SplatStore::prepare(const CollectionPlan& plan, const CollectionBlock& largest, const StaleResults& stale) {
    bricks_listed_ = 0;
    // Free old resources before allocating new ones, so that both never exist at once.
    for (const SplatListRow& row : splat_list_rows())
        lists_.*row.list = {};
    for (const CollectionBufferRow& row : collection_buffer_rows())
        lists_.*row.buffer = {};
    if (stale.edges) lists_.edges = {};
    if (stale.mask) lists_.buried = {};
    clear_counts();
    lists_.surfaces = plan.surfaces;
    std::vector<const gpu::GpuImage*> made;
    for (const auto& row : field_image_rows()) {
        gpu::GpuImage& image = lists_.*row.image;
        if (image || !row.held(plan)) continue;
        image = gpu::GpuImage(session_->device(), row.shape(largest.size), row.text.name);
        made.push_back(&image);
    }
    for (const CollectionBufferRow& row : collection_buffer_rows())
        if (const std::uint64_t bytes = row.bytes(plan, largest.core_size); bytes > 0)
            lists_.*row.buffer = gpu::Buffer(session_->device(), bytes, Place::Host, row.text.name);
    lists_.scene.mapped<shader::SceneParams>(1)[0] = plan.params;
    if (lists_.transfer)
        std::ranges::copy(plan.transfer, lists_.transfer.mapped<shader::TransferRow>(plan.transfer.size()).begin());
    session_->bindings().write_splats(lists_);
    session_->commands().run([&] {
        for (const gpu::GpuImage* image : made)
            session_->commands().prepare({image});
    });
}

void SplatStore::reserve(const CollectionPlan& plan, std::uint64_t count) {
    gpu::Commands& commands = session_->commands();
    auto& params = lists_.scene.mapped<shader::SceneParams>(1)[0];
    for (const SplatListRow& row : splat_list_rows()) {
        const std::uint64_t bytes = row.bytes(plan), used = lists_.splat_count * bytes;
        if (bytes == 0) continue;
        gpu::Buffer& list = lists_.*row.list;
        gpu::Buffer longer(session_->device(), count * bytes, Place::Device, row.text.name);
        if (used > 0) {
            commands.run([&] {
                commands.copy(list, longer, {{0, 0, used}});
                commands.barrier();
            });
        }
        list = std::move(longer);
        params.*row.collected = list.address();
    }
}

void SplatStore::place_block(const CollectionPlan& plan, const CollectionBlock& block) {
    auto& params = lists_.scene.mapped<shader::SceneParams>(1)[0];
    const shader::SceneParams before = params;
    params = plan.params;
    params.dims = block.size;
    params.core_low = block.core_low - block.low;
    params.core_size = block.core_size;
    params.block_origin = block.low;
    params.volume_dims = plan.dims;
    place_planes(params.clip_keep, block.low);
    place_planes(params.clip_remove, block.low);
    params.run_offsets = lists_.run_offsets.address();
    if (bricks_listed_ > 0) params.bricks = lists_.listed_bricks.address();
    params.brick_count = bricks_listed_;
    for (const SplatListRow& row : splat_list_rows())
        params.*row.collected = before.*row.collected;
    if (lists_.transfer) params.transfer = lists_.transfer.address();
}

void SplatStore::mark_block(const CollectionPlan& plan, const CollectionBlock& block) {
    if (!plan.buried) return;
    session_->commands().pass(passes::mark_buried(block.size, plan.params.opaque_count, plan.clip));
}

passes::CollectSplats SplatStore::block_inputs(const CollectionPlan& plan, const CollectionBlock& block) const {
    passes::CollectSplats collect = collect_inputs(plan);
    collect.core_size = block.core_size;
    collect.bricks = bricks_listed_;
    return collect;
}

void SplatStore::count_block(const passes::CollectSplats& collect) {
    std::ranges::fill(lists_.run_offsets.mapped<std::uint32_t>(passes::collect_runs(collect.core_size)), 0U);
    session_->commands().pass(passes::count_splats(collect));
}

void SplatStore::scan_runs(const CollectionBlock& block, CollectedBlock& collected) {
    const BrickRuns runs(block.core_size);
    const auto offsets = lists_.run_offsets.mapped<std::uint32_t>(runs.count());
    std::uint64_t total = lists_.splat_count;
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
    collected.count = total - lists_.splat_count;
    if (box.empty()) box = {glm::ivec3(0), block.core_size - 1};
    collected.low = block.core_low + box.low;
    collected.high = block.core_low + box.high;
}

std::optional<CollectedBlock> SplatStore::list_block(const CollectionPlan& plan, const CollectionBlock& block,
                                                     bool exact, std::uint64_t most_splats, SetupCost& cost) {
    const passes::CollectSplats collect = block_inputs(plan, block);
    CollectedBlock out;
    scan_runs(block, out);
    const std::uint64_t total = out.first + out.count;
    if (total > most_splats) return std::nullopt;
    if (total > kMostSplats) fail("{} splats are visible at once; the splat list allows {}", total, kMostSplats);
    if (exact || total > room()) reserve(plan, exact ? total : std::min(std::max(total, 2 * room()), most_splats));
    // Three counters follow the runs' offsets.
    const std::uint64_t runs = passes::collect_runs(block.core_size);
    const std::span<std::uint32_t> counts = lists_.run_offsets.mapped<std::uint32_t>(runs + 3).subspan(runs);
    std::ranges::fill(counts, 0U);
    auto& params = lists_.scene.mapped<shader::SceneParams>(1)[0];
    params.edge_count_at = static_cast<std::uint32_t>(runs);
    gpu::Commands& commands = session_->commands();
    // In parts, each short enough to say how far it is.
    std::uint64_t done = 0;
    do {
        const std::uint64_t part = std::min(out.count - done, kFinishedAtOnce);
        params.list_first = static_cast<std::uint32_t>(out.first + done);
        params.list_count = static_cast<std::uint32_t>(part);
        commands.run([&] {
            if (done == 0) commands.pass(passes::write_splats(collect));
            commands.pass(passes::finish_splats(collect, part));
        });
        add_times(cost.times, commands.span_times());
        done += part;
        if (cost.progress && out.count > 0) cost.progress(static_cast<double>(done) / static_cast<double>(out.count));
    } while (done < out.count);
    out.with_edge = counts[0];
    out.with_crease = counts[1];
    lists_.splat_count = total;
    lists_.edge_splat_count += out.with_edge;
    lists_.crease_splat_count += out.with_crease;
    // Tracing faces needs the whole field on the device.
    if (!residence_) lists_.traced_splat_count += counts[2];
    return out;
}

void SplatStore::hold_list(CollectedBlock& collected) {
    lists_.box_low = collected.low;
    lists_.box_high = collected.high;
    lists_.bricks.assign(std::move(collected.bricks));
}

std::optional<CollectedBlock> SplatStore::collect_block(const CollectionPlan& plan, const CollectionBlock& block,
                                                        bool exact, std::uint64_t most_splats, SetupCost& cost,
                                                        const StaleResults& stale) {
    place_block(plan, block);
    gpu::Commands& commands = session_->commands();
    const bool estimates = plan.edge_field && stale.edges;
    commands.run([&] {
        if (stale.mask) mark_block(plan, block);
        if (estimates) {
            const passes::EdgeRegion region{block.size, block.core_low - block.low, block.core_size, bricks_listed_};
            // Bricks that are not listed have no edges.
            if (plan.surfaces) {
                commands.clear(lists_.edges);
                commands.barrier();
            }
            commands.pass(passes::estimate_edges(region, estimate_inputs(plan)));
        }
        count_block(block_inputs(plan, block));
    });
    add_times(cost.times, commands.span_times());
    auto out = list_block(plan, block, exact, most_splats, cost);
    if (out && estimates) cost.voxels_estimated += VoxelBox{glm::ivec3(0), block.size - 1}.count();
    return out;
}

void LevelStore::drop_splats() {
    splats.drop();
    surfaces.drop();
}

bool LevelStore::provide(const CollectionPlan& plan, const CollectionPlan* opaque, SetupCost& cost) {
    bool ran = volume.provide();
    // Both lists of a mixture are one task for whoever is told how far it is.
    const auto report = cost.progress;
    const auto collect = [&](SplatStore& list, const CollectionPlan& wanted, double from) {
        if (report && opaque) cost.progress = [&, from](double share) { report(from + 0.5 * share); };
        ran = list.collect(volume, wanted, cost) || ran;
    };
    if (opaque) {
        collect(surfaces, *opaque, 0);
        surfaces.release_fields();
    } else {
        surfaces.drop();
    }
    collect(splats, plan, 0.5);
    cost.progress = report;
    volume.forget_changes();
    return ran;
}

}  // namespace edgesplat

// RendererState: volumes at several resolutions, and those that the device holds block by block.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>

#include "engine/error.h"
#include "engine/plan/resource_table.h"
#include "engine/renderer/state.h"
#include "engine/store/light.h"
#include "engine/volume/filters.h"

namespace edgesplat {
namespace {

using Place = gpu::Buffer::Place;

// A level of so many voxels is there in a moment.
constexpr std::size_t kCoarseVoxels = std::size_t{1} << 17U;

int coarse_level(const Volume& volume) {
    int level = 0;
    while (level + 1 < level_count(volume) && level_geometry(volume.geometry, level).voxel_count() > kCoarseVoxels)
        ++level;
    return level;
}

/// A level as a volume without samples.
std::shared_ptr<const Volume> outline(const Volume& volume, int level) {
    const auto out = std::make_shared<Volume>();
    out->geometry = level_geometry(volume.geometry, level);
    out->in_patient = volume.in_patient;
    out->min_value = volume.min_value;
    out->max_value = volume.max_value;
    out->name = volume.name;
    out->stored_type = volume.stored_type;
    out->checksum = volume.checksum;
    return out;
}

/// Samples of a block, scaled as `scaled_field` scales them.
std::vector<float> scaled_block(const SampleSource& source, const Volume& volume, const CollectionBlock& block) {
    const glm::u64vec3 size(block.size);
    std::vector<float> samples(size.x * size.y * size.z);
    source.read(block.low, block.size, samples);
    for (float& sample : samples)
        sample = static_cast<float>(scaled_value(volume, static_cast<double>(sample)));
    return samples;
}

/// Whether what lies outside the picture counts in it.
bool needs_everything(const Scene& scene) {
    return !shadow_lights(scene).empty();
}

}  // namespace

void RendererState::use_level(int wanted) {
    if (levels.empty()) levels.push_back(original);
    while (static_cast<int>(levels.size()) <= wanted) {
        const int next = static_cast<int>(levels.size());
        levels.push_back(original->values.empty() ? outline(*original, next)
                                                  : std::make_shared<const Volume>(halved(*levels.back())));
    }
    const auto& chosen = levels[static_cast<std::size_t>(wanted)];
    if (volume == chosen) return;
    collected.reset();
    residence.reset();
    raycast.reset();
    volume_resources = {};
    checked.clear();
    volume = chosen;
    level = wanted;
}

void RendererState::show_whole() {
    use_level(0);
    hold_in_blocks(false);
}

void RendererState::hold_in_blocks(bool blocks) {
    if (blocks == in_blocks) return;
    in_blocks = blocks;
    collected.reset();
    residence.reset();
    raycast.reset();
    volume_resources = {};
}

void RendererState::settle(FrameRequest& request, int finest, bool blocks_wanted) {
    use_level(finest);
    request.volume = volume;
    const glm::ivec3 dims = volume->geometry.dims;
    const bool many = std::max({dims.x, dims.y, dims.z}) > kBlockCore;
    bool blocks = volume->values.empty() || (blocks_wanted && many && volume->geometry.voxel_count() > kCoarseVoxels);
    if (!blocks) {
        const auto need = beyond_memory(request);
        blocks = need && many && most_splats_in_blocks(request).value_or(0) > 0;
        if (need && !blocks) refuse_memory(device, request, *need, memory_budget);
    }
    hold_in_blocks(blocks);
}

std::optional<std::uint64_t> RendererState::most_splats_in_blocks(const FrameRequest& request) {
    const Settings drawn = drawn_settings(request);
    const double reach = kernel_reach(drawn);
    CollectionPlan wanted = plan_collection(*request.volume, request.scene, drawn, true);
    // A mask of what is buried may be needed or not.
    wanted.buried = drawn.cull_buried;
    wanted.blocks = true;
    const auto fits = [&](std::uint64_t splats) {
        const SplatCount count{SplatCount::From::Voxels, splats, glm::ivec3(0), request.volume->geometry.dims - 1};
        return memory_need(device, forecast_frame(request, wanted, count, reach, device.profile()), memory_budget)
            .fits();
    };
    if (!fits(0)) return std::nullopt;
    std::uint64_t fitting = 0, beyond = std::uint64_t{1} << 29U;
    while (beyond - fitting > 4096) {
        const std::uint64_t middle = (fitting + beyond) / 2;
        (fits(middle) ? fitting : beyond) = middle;
    }
    return fitting;
}

void RendererState::load_block(const CollectionBlock& block, std::span<const float> samples) {
    upload_block(commands, device, volume_resources.volume, block.size, samples.data(), sizeof(float));
    if (!volume_resources.coefficients) return;
    const auto coefficients = bspline_coefficients({samples.begin(), samples.end()}, block.size);
    upload_block(commands, device, volume_resources.coefficients, block.size, coefficients.data(), sizeof(float));
}

bool RendererState::drop_blocks(const std::vector<std::size_t>& needed, bool shrink) {
    auto& lists = volume_resources;
    std::vector<std::size_t> kept;
    for (std::size_t i = 0; i < residence->held.size(); ++i) {
        auto& held = residence->held[i];
        if (!held) continue;
        if (std::ranges::binary_search(needed, i))
            kept.push_back(i);
        else
            held.reset();
    }
    std::ranges::sort(kept, {}, [&](std::size_t i) { return residence->held[i]->first; });
    const std::uint64_t before = lists.splat_count;
    std::uint64_t count = 0;
    for (const std::size_t i : kept)
        count += residence->held[i]->count;
    if (count == before && !shrink) return false;
    // Each list moves to one of its own length: the parts that stay, one behind the other.
    auto& params = lists.scene.mapped<shader::SceneParams>(1)[0];
    for (const SplatListRow& row : splat_list_rows()) {
        gpu::Buffer& list = lists.*row.list;
        const std::uint64_t bytes = row.bytes(*collected);
        if (!list) continue;
        gpu::Buffer closed(device, std::max<std::uint64_t>(count, 1) * bytes, Place::Device, row.text.name);
        std::vector<vk::BufferCopy> parts;
        std::uint64_t to = 0;
        for (const std::size_t i : kept) {
            const CollectedBlock& part = *residence->held[i];
            if (part.count > 0) parts.emplace_back(part.first * bytes, to * bytes, part.count * bytes);
            to += part.count;
        }
        if (!parts.empty()) {
            commands.run([&] {
                commands.copy(list, closed, parts);
                commands.barrier();
            });
        }
        list = std::move(closed);
        params.*row.collected = list.address();
    }
    lists.splat_count = lists.edge_splat_count = lists.crease_splat_count = 0;
    for (const std::size_t i : kept) {
        residence->held[i]->first = lists.splat_count;
        lists.splat_count += residence->held[i]->count;
        lists.edge_splat_count += residence->held[i]->with_edge;
        lists.crease_splat_count += residence->held[i]->with_crease;
    }
    index_held_blocks();
    return true;
}

void RendererState::begin_blocks(const CollectionPlan& wanted) {
    auto& resources = volume_resources;
    collected.reset();
    drop_targets();
    residence.emplace();
    residence->source = source_of(volume->values.empty() ? original : volume, level);
    residence->blocks = blocks_with_splats(*residence->source, *volume, wanted);
    residence->held.resize(residence->blocks.size());
    resources.volume = {};
    resources.coefficients = {};
    prepare_collection(device, commands, bindings, wanted, largest_block(wanted.dims), resources);
    collected = wanted;
}

std::vector<std::size_t> RendererState::blocks_shown(const FrameRequest& request) {
    const ViewVolume view(volume->geometry, request.camera, request.size, request.scene.effects.antialias);
    const double reach = kernel_reach(drawn_settings(request));
    std::vector<std::size_t> shown;
    for (std::size_t i = 0; i < residence->blocks.size(); ++i) {
        const CollectionBlock& block = residence->blocks[i];
        if (needs_everything(request.scene) || view.shows(block.core_low, block.core_size, reach)) shown.push_back(i);
    }
    // Light comes from all splats.
    if (!divides_blocks || needs_everything(request.scene)) return shown;
    const auto& geometry = volume->geometry;
    const double thickness = sheet_thickness(geometry, request.camera, drawn_settings(request));
    std::vector<CollectionBlock> blocks;
    for (const std::size_t i : shown)
        blocks.push_back(residence->blocks[i]);
    slab = slab_of_part(geometry, request.camera, thickness, blocks, exchange->part());
    std::erase_if(shown, [&](std::size_t i) {
        const glm::ivec2 sheets = sheets_of_block(geometry, request.camera, thickness, reach, residence->blocks[i]);
        return sheets.y <= slab->x || sheets.x >= slab->y;
    });
    return shown;
}

std::vector<float> RendererState::read_block(const std::vector<std::size_t>& missing, std::size_t number) {
    auto& r = *residence;
    const auto begin = [&](std::size_t wanted) {
        r.being_read = wanted;
        r.samples = std::async(std::launch::async, [source = r.source, scaling = volume, block = r.blocks[wanted]] {
            return scaled_block(*source, *scaling, block);
        });
    };
    if (!r.samples.valid() || r.being_read != missing[number]) begin(missing[number]);
    std::vector<float> samples = r.samples.get();
    // The next block is read while the device is at work on this one.
    if (number + 1 < missing.size()) begin(missing[number + 1]);
    return samples;
}

void RendererState::bound_held_blocks() {
    auto& resources = volume_resources;
    resources.box_low = volume->geometry.dims - 1;
    resources.box_high = glm::ivec3(0);
    for (const auto& held : residence->held) {
        if (!held || held->count == 0) continue;
        resources.box_low = glm::min(resources.box_low, held->low);
        resources.box_high = glm::max(resources.box_high, held->high);
    }
    if (resources.splat_count == 0) std::swap(resources.box_low, resources.box_high);
    index_held_blocks();
}

void RendererState::index_held_blocks() {
    std::vector<const CollectedBlock*> held;
    for (const auto& block : residence->held)
        if (block) held.push_back(&*block);
    std::ranges::sort(held, {}, [](const CollectedBlock* block) { return block->first; });
    std::vector<SplatBrick> bricks;
    for (const CollectedBlock* block : held)
        for (SplatBrick brick : block->bricks) {
            brick.first += static_cast<std::uint32_t>(block->first);
            bricks.push_back(brick);
        }
    volume_resources.bricks.assign(std::move(bricks));
}

void RendererState::release_for_collection() {
    drop_targets();
    bindings.write(volume_resources, {});
}

Gathered RendererState::collect_blocks(const FrameRequest& request, const CollectionPlan& wanted,
                                       std::uint64_t most_splats, double wait) {
    auto& resources = volume_resources;
    if (!collected || *collected != wanted || !residence) begin_blocks(wanted);
    const std::vector<std::size_t> needed = blocks_shown(request);
    // Room for more than may come is given back.
    if (resources.splats && resources.splats.bytes() / sizeof(shader::Splat) > most_splats) drop_blocks(needed, true);
    if (resources.splat_count > most_splats) return Gathered::TooMany;
    std::vector<std::size_t> missing;
    std::ranges::copy_if(needed, std::back_inserter(missing), [&](std::size_t i) { return !residence->held[i]; });
    if (missing.empty()) return Gathered::All;
    // Whatever ends this early has added blocks, and the next picture may show no other.
    try {
        const Gathered gathered = collect_missing(request, wanted, needed, std::move(missing), most_splats, wait);
        bound_held_blocks();
        return gathered;
    } catch (...) {
        bound_held_blocks();
        throw;
    }
}

Gathered RendererState::collect_missing(const FrameRequest& request, const CollectionPlan& wanted,
                                        const std::vector<std::size_t>& needed, std::vector<std::size_t> missing,
                                        std::uint64_t most_splats, double wait) {
    const auto start = Clock::now();
    release_for_collection();
    occluded.reset();
    shadowed.reset();
    const bool hides = may_hide_blocks(request);
    if (hides) sort_by_depth(request, missing);
    double looking = 0;
    for (std::size_t number = 0; number < missing.size(); ++number) {
        heed_interruption();
        // The nearest may hide all else, so the first looks come soon; together they take a fifth of the time at most.
        if (hides && 4 * looking <= milliseconds_since(start) - looking) {
            const auto look = Clock::now();
            leave_hidden_blocks(request, missing, number);
            looking += milliseconds_since(look);
            if (number == missing.size()) break;
        }
        if (number > 0 && milliseconds_since(start) > wait) return Gathered::Unfinished;
        const CollectionBlock& block = residence->blocks[missing[number]];
        load_block(block, read_block(missing, number));
        const auto collect = [&] {
            return collect_block(device, commands, wanted, block, false, most_splats, volume_resources);
        };
        auto& held = residence->held[missing[number]];
        held = collect();
        if (!held && drop_blocks(needed, false)) held = collect();
        if (!held) return Gathered::TooMany;
        add_times(collection_times, held->times);
        if (wanted.edge_field) voxels_estimated += VoxelBox{glm::ivec3(0), block.size - 1}.count();
    }
    return Gathered::All;
}

Gathered RendererState::collect_in_blocks(const FrameRequest& request, double wait, double& milliseconds) {
    if (occludes_ambient(request.scene)) {
        fail("occlusion: {} is held on the device block by block, expected a volume that fits as a whole",
             original->name);
    }
    const auto start = Clock::now();
    collection_times.clear();
    const auto most = most_splats_in_blocks(request);
    if (!most) return Gathered::TooMany;
    const Settings settings = drawn_settings(request);
    const bool keep_buried = request.outputs.tau || eye_in_opaque(*original, request.scene, request.camera);
    CollectionPlan wanted = plan_collection(*volume, request.scene, settings, keep_buried);
    wanted.blocks = true;
    const Gathered gathered = collect_blocks(request, wanted, *most, wait);
    if (gathered == Gathered::All) cast_shadows(request.scene, settings);
    if (!collection_times.empty()) milliseconds += milliseconds_since(start);
    return gathered;
}

bool RendererState::agree_on_level(int& finest) {
    slab.reset();
    divides_blocks = exchange && exchange->largest(in_blocks ? 0 : 1) == 0;
    const int coarsest = exchange ? exchange->largest(level) : level;
    if (!exchange || -exchange->largest(-level) == coarsest) return true;
    finest = coarsest;
    return false;
}

bool RendererState::too_many_somewhere(Gathered gathered) {
    const bool here = gathered == Gathered::TooMany;
    if (!exchange) return here;
    if (exchange->largest(here ? 1 : 0) > 0) return true;
    if (!divides_blocks) return false;
    // Sheets and what the device rounds are counted from the box of the splats.
    glm::ivec3 &low = volume_resources.box_low, &high = volume_resources.box_high;
    const bool none = volume_resources.splat_count == 0;
    const glm::ivec3 last = volume->geometry.dims - 1;
    for (int axis = 0; axis < 3; ++axis) {
        low[axis] = -exchange->largest(none ? -last[axis] : -low[axis]);
        high[axis] = exchange->largest(none ? 0 : high[axis]);
    }
    if (glm::any(glm::greaterThan(low, high))) {
        low = glm::ivec3(0);
        high = last;
    }
    return false;
}

Gathered RendererState::provide_level(FrameRequest request, int finest, double wait, RenderStats& stats) {
    const Settings settings = drawn_settings(request);
    const int count = level_count(*original);
    const int countable = countable_level(original->geometry, count, finest);
    if (countable == count) {
        const glm::ivec3 dims = level_geometry(original->geometry, count - 1).dims;
        fail("{}: {} x {} x {} voxels at the coarsest of its {} resolutions, expected at most 2^32", original->name,
             dims.x, dims.y, dims.z, count);
    }
    for (int at = countable;; ++at) {
        settle(request, at, std::isfinite(patience));
        while (!agree_on_level(at))
            settle(request, at, std::isfinite(patience));
        release_unused(settings);
        Gathered gathered = Gathered::All;
        if (in_blocks) {
            gathered = collect_in_blocks(request, wait, stats.setup_milliseconds);
        } else {
            provide_volume();
            stats.setup_milliseconds += collect(request.scene, settings, keeps_buried(request));
        }
        if (!too_many_somewhere(gathered)) return gathered;
        const auto need = volume->values.empty() ? std::nullopt : beyond_memory(request);
        if (need) refuse_memory(device, request, *need, memory_budget);
        if (at + 1 == count) {
            fail("{}: the picture does not fit into the device's memory at any of its {} resolutions", original->name,
                 count);
        }
    }
}

void RendererState::provide_splats(const FrameRequest& request, RenderStats& stats) {
    const int count = level_count(*original);
    if (other.volume) exchange_sets();  // go on with what was on its way
    stats.wanted_level =
        level_for(original->geometry, count, request.camera, request.size, drawn_settings(request).detail);
    if (provide_level(request, stats.wanted_level, patience, stats) == Gathered::All) {
        other = {};
    } else {
        exchange_sets();
        const int coarse = std::max(stats.wanted_level, coarse_level(*original));
        provide_level(request, coarse, std::numeric_limits<double>::infinity(), stats);
        stats.complete = false;
    }
    stats.level = level;
    stats.in_blocks = in_blocks;
    if (!in_blocks) return;
    stats.blocks = residence->blocks.size();
    stats.blocks_held = static_cast<std::uint64_t>(
        std::ranges::count_if(residence->held, [](const auto& held) { return held.has_value(); }));
}

}  // namespace edgesplat

// SplatProvider: collects a picture's splats block by block, skipping blocks that it does not show.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "engine/clock.h"
#include "engine/error.h"
#include "engine/renderer/splat_provider.h"
#include "footprints/kernel.h"

namespace edgesplat {
namespace {

/// Rays may have to search the whole volume for surface splats.
Settings settings_in_blocks(const FrameRequest& request) {
    Settings settings = drawn_settings(request);
    settings.opaque = OpaqueMatter::Kernels;
    return settings;
}

/// First sheet, numbered from the eye on, that kernels of a block's voxels may reach. `geometry`: of the block's level.
int first_sheet(const VolumeGeometry& geometry, const FrameRequest& request, const CollectionBlock& block) {
    constexpr double kMostSheets = 2e9;
    const Settings drawn = drawn_settings(request);
    const CameraFrame view = camera_frame(request.camera);
    const double reach = kernel_reach(drawn);
    const glm::dvec3 low = glm::dvec3(block.core_low) - reach;
    const glm::dvec3 high = glm::dvec3(block.core_low + block.core_size - 1) + reach;
    double depth = std::numeric_limits<double>::max();
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 at = glm::mix(low, high, glm::bvec3((corner & 1) != 0, (corner & 2) != 0, (corner & 4) != 0));
        depth = std::min(depth, glm::dot(view.forward, geometry.to_world(at) - view.eye));
    }
    // One less for the device's rounding.
    const double sheet = std::floor(depth / sheet_thickness(geometry, request.camera, drawn)) - 1;
    return static_cast<int>(std::clamp(sheet, 0.0, kMostSheets));
}

}  // namespace

std::optional<std::uint64_t> SplatProvider::most_splats_in_blocks(const FrameRequest& request) const {
    const Settings drawn = settings_in_blocks(request);
    const double reach = kernel_reach(drawn);
    CollectionPlan wanted = plan_collection(*request.volume, request.scene, drawn, true);
    // Assume that a mask of buried voxels is needed unless the settings exclude it.
    wanted.buried = drawn.cull_buried;
    wanted.blocks = true;
    const auto fits = [&](std::uint64_t splats) {
        const SplatCount count{SplatCount::From::Voxels, {splats, glm::ivec3(0), request.volume->geometry.dims - 1}};
        return memory_need(session_->device(), forecast_part(request, wanted, count, reach, session_->profile()),
                           options_->memory_budget)
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

SplatProvider::Gathered SplatProvider::collect_in_blocks(const FrameRequest& request, double patience,
                                                         double& milliseconds) {
    const Volume& original = *levels_.original();
    const bool shadowed = !shadow_lights(request.scene).empty();
    if (shadowed || occludes_ambient(request.scene)) {
        fail("{}: {} is on the device block by block, expected a volume that fits as a whole",
             shadowed ? "shadows" : "occlusion", original.name);
    }
    const auto start = Clock::now();
    const auto most = most_splats_in_blocks(request);
    if (!most) return Gathered::TooMany;
    const Settings settings = settings_in_blocks(request);
    const bool keep_buried = request.outputs.tau || eye_in_opaque(original, request.scene, request.camera);
    CollectionPlan wanted = plan_collection(*shown_.volume.volume(), request.scene, settings, keep_buried);
    wanted.blocks = true;
    const Gathered gathered = collect_blocks(request, wanted, *most, patience);
    if (!cost_.times.empty()) milliseconds += milliseconds_since(start);
    return gathered;
}

SplatProvider::Gathered SplatProvider::collect_blocks(const FrameRequest& request, const CollectionPlan& wanted,
                                                      std::uint64_t most_splats, double patience) {
    SplatStore& splats = shown_.splats;
    const auto& held = splats.collected();
    const bool keeps = held && splats.has_blocks() && !stale_results(*held, wanted).lists;
    if (keeps && *held != wanted) splats.classify(wanted);
    if (!keeps) {
        const auto& level = shown_.volume.volume();
        drawer_->targets().drop();
        splats.begin_blocks(shown_.volume,
                            source_of(level->values.empty() ? levels_.original() : level, shown_.volume.level()),
                            wanted);
    }
    const std::vector<std::size_t> needed = blocks_shown(request);
    // Give back room beyond the limit.
    if (splats.room() > most_splats) splats.drop_blocks(needed, true);
    if (splats.lists().splat_count > most_splats) return Gathered::TooMany;
    std::vector<std::size_t> missing;
    std::ranges::copy_if(needed, std::back_inserter(missing), [&](std::size_t i) { return !splats.holds(i); });
    if (missing.empty()) return Gathered::All;
    // An early end, too, has added blocks; the next picture may need only these, so the box must be right.
    try {
        const Gathered gathered = collect_missing(request, needed, std::move(missing), most_splats, patience);
        splats.bound_blocks(shown_.volume);
        return gathered;
    } catch (...) {
        splats.bound_blocks(shown_.volume);
        throw;
    }
}

SplatProvider::Gathered SplatProvider::collect_missing(const FrameRequest& request,
                                                       const std::vector<std::size_t>& needed,
                                                       std::vector<std::size_t> missing, std::uint64_t most_splats,
                                                       double patience) {
    const auto start = Clock::now();
    drawer_->targets().drop();
    shown_.splats.bind(shown_.volume);
    shown_.splats.forget_light();
    const bool skips_hidden = can_skip_hidden_blocks(request);
    if (skips_hidden) sort_by_depth(request, missing);
    double testing = 0;
    for (std::size_t number = 0; number < missing.size(); ++number) {
        options_->throw_if_interrupted();
        // Near blocks may occlude the rest, so visibility is tested early; the tests take at most a fifth of the time.
        if (skips_hidden && 4 * testing <= milliseconds_since(start) - testing) {
            const auto test_start = Clock::now();
            skip_hidden_blocks(request, missing, number);
            testing += milliseconds_since(test_start);
            if (number == missing.size()) break;
        }
        if (number > 0 && milliseconds_since(start) > patience) return Gathered::Unfinished;
        const auto after = number + 1 < missing.size() ? std::optional(missing[number + 1]) : std::nullopt;
        if (!shown_.splats.add_block(shown_.volume, missing[number], after, needed, most_splats, cost_))
            return Gathered::TooMany;
    }
    return Gathered::All;
}

std::vector<std::size_t> SplatProvider::blocks_shown(const FrameRequest& request) const {
    const auto& geometry = shown_.volume.volume()->geometry;
    const auto blocks = shown_.splats.blocks();
    const ViewVolume view(geometry, request.camera, request.size, request.scene.effects.antialias);
    const double reach = kernel_reach(drawn_settings(request));
    std::vector<std::size_t> shown;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        const CollectionBlock& block = blocks[i];
        if (view.shows(block.core_low, block.core_size, reach)) shown.push_back(i);
    }
    return shown;
}

bool SplatProvider::can_skip_hidden_blocks(const FrameRequest& request) const {
    const Settings drawn = drawn_settings(request);
    // Optical depth needs occluded splats; several samples are several pictures, each with its own view.
    return !request.outputs.tau && request.scene.effects.samples == 1 && drawn.saturation < 1 &&
           drawn.sheet_format == SheetFormat::Tiles;
}

void SplatProvider::sort_by_depth(const FrameRequest& request, std::vector<std::size_t>& blocks) const {
    const VolumeGeometry& geometry = shown_.volume.volume()->geometry;
    std::ranges::stable_sort(blocks, {},
                             [&](std::size_t i) { return first_sheet(geometry, request, shown_.splats.blocks()[i]); });
}

void SplatProvider::skip_hidden_blocks(const FrameRequest& request, std::vector<std::size_t>& missing,
                                       std::size_t first) {
    if (shown_.splats.lists().splat_count == 0 || first + 1 >= missing.size()) return;
    const auto blocks = shown_.splats.blocks();
    // All missing blocks lie behind these sheets, so pixels that they saturate are saturated in the whole picture.
    const int sheet = first_sheet(shown_.volume.volume()->geometry, request, blocks[missing[first]]);
    shown_.splats.bound_blocks(shown_.volume);
    const OpenTiles open = drawer_->open_tiles(shown_, request, sheet);
    const auto is_hidden = [&](std::size_t i) {
        const CollectionBlock& block = blocks[i];
        return !open.may_show({block.core_low, block.core_low + block.core_size - 1});
    };
    const auto behind = missing.begin() + static_cast<std::ptrdiff_t>(first);
    missing.erase(std::remove_if(behind, missing.end(), is_hidden), missing.end());
}

}  // namespace edgesplat

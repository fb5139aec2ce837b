#include "engine/renderer/splat_provider.h"

#include <algorithm>
#include <cmath>

#include "engine/clock.h"
#include "engine/error.h"
#include "engine/forecast/description_passes.h"

namespace edgesplat {

SplatProvider::SplatProvider(DeviceSession& session, const RenderOptions& options, PictureDrawer& drawer,
                             std::optional<RaycastResources>& rays)
    : session_(&session), options_(&options), drawer_(&drawer), rays_(&rays), shown_(session), other_(session) {}

void SplatProvider::set_volume(std::shared_ptr<const Volume> volume) {
    if (take_changes(volume)) return;
    // Even the same object may have new samples, so everything is freed.
    drawer_->targets().drop();
    rays_->reset();
    checked_.clear();
    shown_ = LevelStore(*session_);
    other_ = LevelStore(*session_);
    levels_.set(std::move(volume));
    if (levels_.original())
        use_level(0);
    else
        added_.clear();
}

bool SplatProvider::take_changes(const std::shared_ptr<const Volume>& next) {
    const auto& original = levels_.original();
    if (!next || !original || next == original || shown_.volume.in_blocks() || shown_.volume.volume() != original ||
        !shown_.volume.images().volume || !shown_.splats.collected())
        return false;
    const auto box = changed_box(*original, *next);
    if (!box) return false;
    other_ = LevelStore(*session_);
    rays_->reset();
    levels_.set(next);
    shown_.volume.change(next, *box);
    return true;
}

void SplatProvider::use_level(int level) {
    if (!shown_.volume.hold(levels_.at(level), level)) return;
    shown_.drop_splats();
    rays_->reset();
    checked_.clear();
}

void SplatProvider::hold_in_blocks(bool blocks) {
    if (!shown_.volume.hold_in_blocks(blocks)) return;
    shown_.drop_splats();
    rays_->reset();
}

void SplatProvider::release_unused(const Settings& drawn) {
    const bool estimates = draws_warped(drawn) && drawn.edges == EdgeEstimator::Cubic;
    if (!estimates && !(*rays_ && (*rays_)->takes_coefficients())) shown_.volume.release_coefficients();
}

bool SplatProvider::provide_volume(bool coefficients) {
    use_level(0);
    hold_in_blocks(false);
    const bool missing = shown_.volume.provide();
    return (coefficients && shown_.volume.provide_coefficients()) || missing;
}

void SplatProvider::hold_added(const FrameRequest& request) {
    std::vector<Added> held;
    for (const AddedVolume& wanted : request.scene.added) {
        if (wanted.volume->values.empty())
            fail("{}: a packed volume is drawn in blocks, expected volumes in memory beside each other",
                 wanted.volume->name);
        const auto found =
            std::ranges::find_if(added_, [&](const Added& one) { return one.levels.original() == wanted.volume; });
        if (found != added_.end()) {
            held.push_back(std::move(*found));
            added_.erase(found);
        } else {
            held.emplace_back(*session_).levels.set(wanted.volume);
        }
        Added& one = held.back();
        const int level = level_for(wanted.volume->geometry, one.levels.count(), request.camera, request.size,
                                    drawn_settings(request).detail);
        if (one.shown.volume.hold(one.levels.at(level), level)) one.shown.drop_splats();
    }
    added_ = std::move(held);
}

void SplatProvider::show_levels(FrameRequest& request) const {
    request.volume = shown_.volume.volume();
    for (std::size_t i = 0; i < added_.size(); ++i)
        request.scene.added[i].volume = added_[i].shown.volume.volume();
}

std::optional<SplatCount> SplatProvider::collected_splats(const FrameRequest& part,
                                                          const CollectionPlan& wanted) const {
    if (part.number > added_.size()) return std::nullopt;
    const LevelStore& store = level(part.number);
    if (store.volume.volume() != part.volume || store.volume.changed()) return std::nullopt;
    for (const SplatStore* list : {&store.splats, &store.surfaces})
        if (list->collected() && !stale_results(*list->collected(), wanted).lists)
            return SplatCount{SplatCount::From::Frame, list->lists().extent()};
    return std::nullopt;
}

std::optional<MemoryNeed> SplatProvider::memory_shortfall(const FrameRequest& request) {
    bool known = true;
    const auto count_at_once = [&](const FrameRequest& part, const CollectionPlan& wanted) {
        const auto collected = collected_splats(part, wanted);
        known = known && collected;
        return collected.value_or(most_splats(wanted));
    };
    FrameForecast forecast = forecast_frame(request, count_at_once, session_->profile());
    std::vector<std::pair<std::string, std::uint64_t>> needed;
    for (const PlannedResource& resource : forecast.resources)
        needed.emplace_back(resource.text.name, resource.bytes);
    if (needed == checked_) return checked_need_;
    MemoryNeed need = memory_need(session_->device(), forecast, options_->memory_budget);
    // The upper bound by the number of voxels is too high for most volumes; exact counting takes longer.
    if (!need.fits() && !known) {
        forecast = forecast_frame(request, count_splats_of, session_->profile());
        need = memory_need(session_->device(), forecast, options_->memory_budget);
    }
    session_->pipelines().create_ahead(pipelines_of(request, forecast));
    checked_ = std::move(needed);
    checked_need_ = need.fits() ? std::nullopt : std::optional(std::move(need));
    return checked_need_;
}

void SplatProvider::settle(FrameRequest& request, int finest) {
    use_level(finest);
    show_levels(request);
    const Volume& volume = *request.volume;
    const bool several = !added_.empty();
    if (several && volume.values.empty())
        fail("{}: a packed volume is drawn in blocks, expected volumes in memory beside each other", volume.name);
    const glm::ivec3 dims = volume.geometry.dims;
    const bool many = std::max({dims.x, dims.y, dims.z}) > kBlockCore;
    const bool wanted = std::isfinite(options_->patience);
    bool blocks =
        volume.values.empty() || (wanted && many && !several && volume.geometry.voxel_count() > kCoarseVoxels);
    if (!blocks) {
        const auto need = memory_shortfall(request);
        blocks = need && many && !several && most_splats_in_blocks(request).value_or(0) > 0;
        if (need && !blocks) refuse_memory(session_->device(), request, *need, options_->memory_budget);
    }
    hold_in_blocks(blocks);
}

SplatProvider::Gathered SplatProvider::provide_level(FrameRequest request, int finest, double patience,
                                                     RenderStats& stats) {
    const Settings settings = drawn_settings(request);
    const Volume& original = *levels_.original();
    const int count = levels_.count();
    const int countable = countable_level(original.geometry, count, finest);
    if (countable == count) {
        const glm::ivec3 dims = level_geometry(original.geometry, count - 1).dims;
        fail("{}: {} x {} x {} voxels at the coarsest of its {} resolutions, expected at most 2^32", original.name,
             dims.x, dims.y, dims.z, count);
    }
    for (int at = countable;; ++at) {
        settle(request, at);
        release_unused(settings);
        Gathered gathered = Gathered::All;
        cost_.times.clear();
        if (shown_.volume.in_blocks())
            gathered = collect_in_blocks(request, patience, stats.setup_milliseconds);
        else
            stats.setup_milliseconds += provide_undivided(request);
        if (gathered != Gathered::TooMany) return gathered;
        const auto need = request.volume->values.empty() ? std::nullopt : memory_shortfall(request);
        if (need) refuse_memory(session_->device(), request, *need, options_->memory_budget);
        if (at + 1 == count) {
            fail("{}: the picture does not fit into the device's memory at any of its {} resolutions", original.name,
                 count);
        }
    }
}

double SplatProvider::provide_undivided(const FrameRequest& request) {
    const auto start = Clock::now();
    bool found = false;
    std::vector<LitVolume> lit;
    const auto report = cost_.progress;
    std::vector<LevelStore*> stores{&shown_};
    for (Added& beside : added_)
        stores.push_back(&beside.shown);
    for (std::size_t number = 0; number < stores.size(); ++number) {
        const FrameRequest one = request_of_volume(request, number);
        LevelStore& store = *stores[number];
        // A volume without matter beside others has no part.
        if (stores.size() > 1 && !has_matter(one.scene)) {
            store.drop_splats();
            continue;
        }
        std::vector<CollectionPlan> plans;
        std::ranges::transform(parts_of_volume(one), std::back_inserter(plans), planned_collection);
        const CollectionPlan* opaque = plans.size() > 1 ? &plans.front() : nullptr;
        const auto all = static_cast<double>(stores.size());
        if (report) cost_.progress = [&, number](double share) { report((static_cast<double>(number) + share) / all); };
        found = store.provide(plans.back(), opaque, cost_) || found;
        lit.push_back({&store, one.scene});
    }
    cost_.progress = report;
    found = light_volumes(lit, cost_) || found;
    return found ? milliseconds_since(start) : 0;
}

void SplatProvider::provide(const FrameRequest& request, RenderStats& stats) {
    cost_ = {.times = {}, .voxels_estimated = 0, .progress = options_->progress, .kept = options_->kept_splats};
    if (other_.volume.volume()) std::swap(shown_, other_);  // resume the unfinished level
    hold_added(request);
    stats.wanted_level =
        level_for(original()->geometry, levels_.count(), request.camera, request.size, drawn_settings(request).detail);
    if (provide_level(request, stats.wanted_level, options_->patience, stats) == Gathered::All) {
        other_ = LevelStore(*session_);
    } else {
        std::swap(shown_, other_);
        const int coarse = std::max(stats.wanted_level, levels_.coarse());
        provide_level(request, coarse, std::numeric_limits<double>::infinity(), stats);
        stats.complete = false;
    }
    stats.level = shown_.volume.level();
    stats.in_blocks = shown_.volume.in_blocks();
    stats.voxels_estimated = cost_.voxels_estimated;
    stats.splats_read = cost_.read;
    if (stats.setup_milliseconds > 0) stats.passes = cost_.times;
    if (!stats.in_blocks) return;
    stats.blocks = shown_.splats.blocks().size();
    stats.blocks_held = shown_.splats.blocks_held();
}

}  // namespace edgesplat

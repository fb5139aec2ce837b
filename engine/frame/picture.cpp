#include "engine/frame/picture.h"

#include <algorithm>
#include <iterator>
#include <limits>

#include "engine/error.h"
#include "engine/frame/tiles_cpu/front_first.h"
#include "engine/frame/tiles_cpu/lists.h"
#include "engine/gpu/read_back.h"
#include "footprints/kernel.h"

namespace edgesplat {

void need_layers(const gpu::Device& device, const Scene& scene, const Settings& settings) {
    const std::string& obstacle = device.layers_obstacle();
    if (obstacle.empty()) return;
    if (canonical_settings(settings, scene).sheet_format != SheetFormat::Tiles)
        fail("sheet_format: {} has {}, expected `tiles`", device.info().name, obstacle);
}

namespace {

FramePlan plan_of_kernels(std::span<const PicturePart> parts) {
    if (parts.size() == 1) return parts.front().plan;
    std::vector<FramePlan> plans;
    std::ranges::transform(parts, std::back_inserter(plans), &PicturePart::plan);
    return plan_together(plans);
}

}  // namespace

FramePlan PictureDrawer::plan(const CollectedSplats& list, const Scene& scene, const Camera& camera,
                              const Settings& settings, const glm::ivec2& size, std::uint32_t payload) const {
    const Volume& volume = *list.volume.volume();
    const SplatLists& splats = list.splats.lists();
    FramePlan out = plan_frame(volume, scene, camera, settings, size, payload, splats.extent(), kernel_reach(settings),
                               session_->profile().refines);
    out.params.chunk_slots = std::min(expected_chunks_[splats.surfaces ? 1 : 0], out.params.sheet_count);
    if (culling_.bricks) cull_bricks(out, splats.bricks, {volume.geometry, camera, size, out.variant.antialias});
    return out;
}

void PictureDrawer::draw(const CollectedSplats& list, FramePlan plan) {
    beside_.clear();
    drawn_before_ = 0;
    counts_before_ = {};
    draw_lists({list}, std::move(plan));
}

void PictureDrawer::draw_lists(std::vector<CollectedSplats> lists, FramePlan plan) {
    plan_ = std::move(plan);
    lists_ = std::move(lists);
    if (options_->check_numbers)
        for (const CollectedSplats& list : lists_)
            check_splats(*session_, list);
    draw_planned();
    examined_ = plan_.splats_examined;
    if (options_->check_numbers) check_picture();
}

void PictureDrawer::draw_parts(std::vector<PicturePart> parts, bool several_volumes) {
    const auto kernels =
        std::ranges::find_if(parts, [](const PicturePart& part) { return !part.plan.variant.surfaces; });
    const bool mixed = kernels != parts.begin();
    for (PicturePart& part : parts) {
        part.plan.variant.mixed = mixed;
        part.plan.variant.several = mixed && several_volumes;
        part.plan.first = &part == &parts.front();
    }
    beside_.clear();
    for (auto part = parts.begin(); part != kernels; ++part)
        beside_.push_back(part->plan);
    if (kernels != parts.end()) beside_.push_back(plan_of_kernels({kernels, parts.end()}));
    drawn_before_ = 0;
    counts_before_ = {};
    std::uint64_t examined = 0;
    std::vector<PassTime> times;
    std::vector<float> ends;  // of the tiles' rays, at surfaces of all parts so far
    const auto draw = [&](std::vector<CollectedSplats> lists, FramePlan plan) {
        if (!plan.first) {
            drawn_before_ = splats_drawn();
            counts_before_ = counts();
        }
        draw_lists(std::move(lists), std::move(plan));
        add_times(times, times_);
        examined += examined_;
    };
    const auto cull = [&](PicturePart& part) {
        if (!ends.empty()) cull_behind(part.plan, part.list.splats.lists().bricks, ends);
    };
    for (auto part = parts.begin(); part != kernels; ++part) {
        cull(*part);
        draw({part->list}, std::move(part->plan));
        const auto own = targets_.resources().tile_ends.mapped<float>(tile_count(plan_));
        ends.resize(own.size(), std::numeric_limits<float>::infinity());
        std::ranges::transform(ends, own, ends.begin(), [](float a, float b) { return std::min(a, b); });
    }
    if (kernels != parts.end()) {
        std::vector<CollectedSplats> lists;
        for (auto part = kernels; part != parts.end(); ++part) {
            cull(*part);
            lists.push_back(part->list);
        }
        draw(std::move(lists), plan_of_kernels({kernels, parts.end()}));
    } else {
        add_times(times, join_volumes(session_->commands(), plan_, targets_.resources()));
    }
    examined_ = examined;
    times_ = std::move(times);
}

void PictureDrawer::provide_targets() {
    targets_.provide(plan_, lists_, beside_);
}

void PictureDrawer::draw_planned() {
    lists_.front().splats.bind(lists_.front().volume);
    provide_targets();
    gpu::Commands& commands = session_->commands();
    if (!plan_.variant.tiles) {
        times_ = draw_layers(commands, plan_, targets_.resources());
        return;
    }
    const passes::TileDraw how{.profile = &session_->profile(), .count = options_->counting};
    times_.clear();
    if (draw_front_first(how)) return;
    // Expect as many chunks as the last picture had: an empty one costs as much as waiting once. 0 if the device could
    // not have planned them.
    const auto foresee = [&](const Chunks& chunks) {
        const auto count = std::max(static_cast<std::uint32_t>(chunks.parts.size()), 1U);
        expected_chunks_[plan_.variant.surfaces ? 1 : 0] = fit(chunks, plan_.params, count) ? count : 0;
    };
    const bool chunks_foreseen = plan_.params.chunk_slots > 0 && !how.profile->rounds && !plan_.refined;
    if (chunks_foreseen) {
        const std::optional<Chunks> chunks = draw_at_once(commands, plan_, targets_.resources(), how);
        add_times(times_, commands.span_times());
        if (chunks) return foresee(*chunks);
    }
    const Chunks chunks = sort_frame(commands, plan_, targets_.resources());
    add_times(times_, commands.span_times());
    plan_.refined = plan_.refined && should_refine(chunks);
    draw_chunks(chunks, how);
    foresee(chunks);
}

bool PictureDrawer::draw_front_first(const passes::TileDraw& how) {
    const CollectedSplats& list = lists_.front();
    const auto& collected = list.splats.collected();
    if (!session_->profile().front_first || !collected || !(collected->buried || collected->surfaces)) return false;
    const SplatLists& splats = list.splats.lists();
    const TargetResources& targets = targets_.resources();
    gpu::Commands& commands = session_->commands();
    const auto divided = divide_front(plan_, splats.bricks, culling_.min_splats_to_hide);
    if (!divided) return false;
    const FramePlan whole = plan_;
    draw_bricks(plan_, splats.bricks, divided->front);
    plan_.params.sheets_drawn = static_cast<std::uint32_t>(std::max(divided->sheet - plan_.params.sheet_base, 0));
    provide_targets();
    Chunks chunks = sort_frame(commands, plan_, targets, {.end = divided->sheet});
    times_ = commands.span_times();
    if (whole.refined && should_refine(chunks)) {
        plan_ = whole;
        provide_targets();
        return false;
    }
    plan_.refined = false;
    passes::TileDraw front = how;
    front.part = true;
    draw_chunks(chunks, front);
    const auto counts = targets.drawn.mapped<std::uint32_t>(3);
    const std::uint32_t evaluated = counts[1], shaded = counts[2];
    const auto in_front = static_cast<std::uint32_t>(chunks.entries);
    const auto pairs_now = targets.sheet_pairs.mapped<std::uint32_t>(plan_.params.sheet_count);
    const std::vector<std::uint32_t> pairs(pairs_now.begin(), pairs_now.begin() + chunks.sheets.y);
    const std::uint64_t splats_examined = plan_.splats_examined;
    const auto closed =
        gpu::read_back<std::uint32_t>(session_->device(), commands, targets.tile_closed, 0, tile_count(plan_));

    const OpenTiles open(plan_, closed);
    std::vector<std::uint32_t> shown;
    std::ranges::copy_if(divided->rest, std::back_inserter(shown),
                         [&](std::uint32_t number) { return open.may_show(splats.bricks.bricks()[number].box); });
    draw_bricks(plan_, splats.bricks, shown);
    provide_targets();
    chunks = sort_frame(commands, plan_, targets, {.begin = divided->sheet, .continues = true});
    add_times(times_, commands.span_times());
    draw_chunks(chunks, how);
    // Statistics of the picture are of both parts.
    plan_.splats_examined += splats_examined;
    std::ranges::copy(pairs, pairs_now.begin());
    counts[0] = in_front + static_cast<std::uint32_t>(chunks.entries);
    counts[1] += evaluated;
    counts[2] += shaded;
    return true;
}

void PictureDrawer::draw_chunks(const Chunks& chunks, const passes::TileDraw& how) {
    targets_.provide_chunks(plan_, chunks);
    std::function<void()> between;
    if (options_->interruption) between = [this] { options_->throw_if_interrupted(); };
    add_times(times_, draw_tiles(session_->commands(), plan_, targets_.resources(),
                                 static_cast<std::uint32_t>(chunks.parts.size()), how, between));
}

OpenTiles PictureDrawer::open_tiles(const LevelStore& level, const FrameRequest& request, int sheet) {
    gpu::Commands& commands = session_->commands();
    plan_ = plan(level.all(), request.scene, request.camera, canonical_settings(request.settings, request.scene),
                 request.size, shader::PAYLOAD_COLOR);
    // A stricter saturation than the picture's, since a plan for another box of splats rounds differently.
    plan_.params.saturation += 0.2F * (1 - plan_.params.saturation);
    plan_.refined = plan_.may_refine = false;
    level.splats.bind(level.volume);
    lists_ = std::vector<CollectedSplats>{level.all()};
    targets_.provide(plan_, lists_);
    const TargetResources& targets = targets_.resources();
    const Chunks chunks = sort_frame(commands, plan_, targets, {.end = sheet});
    targets_.provide_chunks(plan_, chunks);
    draw_tiles(commands, plan_, targets, static_cast<std::uint32_t>(chunks.parts.size()),
               {.profile = &session_->profile(), .part = true});
    const auto closed =
        gpu::read_back<std::uint32_t>(session_->device(), commands, targets.tile_closed, 0, tile_count(plan_));
    targets_.drop();
    return {plan_, closed};
}

namespace {

/// Share of the picture's tiles that a sheet's splats touch, averaged over the sheets. A tile counts once per splat;
/// each sheet counts at most 1.
double dirty_share_of_tiles(const FramePlan& plan, const TargetResources& targets) {
    const auto tiles = static_cast<double>(tile_count(plan));
    double sum = 0;
    for (const std::uint32_t pairs : sheet_pairs(plan, targets))
        sum += std::min(pairs / tiles, 1.0);
    return sum / plan.params.sheet_count;
}

}  // namespace

PictureCounts PictureDrawer::counts() const {
    const TargetResources& targets = targets_.resources();
    if (plan_.variant.tiles) {
        const auto counts = targets.drawn.mapped<std::uint32_t>(3);
        const DrawCounts before = counts_before_.draws.value_or(DrawCounts{});
        return {
            DrawCounts{.vertices = 0, .fragments = before.fragments + counts[1], .shaded = before.shaded + counts[2]},
            dirty_share_of_tiles(plan_, targets)};
    }
    const auto groups = targets.groups.mapped<shader::SheetGroup>(plan_.params.group_count);
    double covered = 0;
    for (const shader::SheetGroup& group : groups)
        covered += static_cast<double>(std::max(group.rect.z - group.rect.x, 0)) *
                   static_cast<double>(std::max(group.rect.w - group.rect.y, 0));
    const double pixels = static_cast<double>(plan_.params.size.x) * static_cast<double>(plan_.params.size.y);
    return {session_->commands().draw_counts(), covered / pixels / static_cast<double>(groups.size())};
}

}  // namespace edgesplat

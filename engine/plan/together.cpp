// Plans kernels of several volumes as one list: they share sheets, tiles and pixels; each keeps its grid.
#include <algorithm>
#include <map>

#include "engine/plan/plan.h"

namespace edgesplat {
namespace {

constexpr float kNowhere = 1e9F;  ///< offset of a clip plane that cuts nothing, voxels

/// What some volume's kernels need, all have.
passes::DrawVariant variant_of_all(std::span<const FramePlan> plans) {
    passes::DrawVariant all = plans.front().variant;
    std::map<std::uint32_t, std::uint32_t> shading;
    all.together = true;
    for (const FramePlan& plan : plans) {
        const passes::DrawVariant& own = plan.variant;
        if (own.footprints != FootprintMode::Isotropic) {
            all.footprints = own.footprints;
            all.warp = own.warp;
        }
        all.nodes = std::max(all.nodes, own.nodes);
        all.clip.keep = std::max(all.clip.keep, own.clip.keep);
        all.clip.remove = std::max(all.clip.remove, own.clip.remove);
        all.opaque &= own.opaque;
        all.creases |= own.creases;
        all.outlines |= own.outlines;
        all.rim |= own.rim;
        for (const auto& [id, value] : own.shading)
            shading[id] = std::max(shading[id], value);
    }
    all.shading.assign(shading.begin(), shading.end());
    return all;
}

/// Adds clip planes that cut nothing to a volume that has fewer than others.
void fill_clip(shader::VolumeParams& volume, const passes::ClipCount& own, const passes::ClipCount& all) {
    for (std::uint32_t i = own.keep; i < all.keep; ++i)
        volume.clip_keep[i] = glm::vec4(0, 0, 0, -kNowhere);
    // The planes remove a region together: none, or the one of the volume's own planes.
    for (std::uint32_t i = own.remove; i < all.remove; ++i)
        volume.clip_remove[i] = glm::vec4(0, 0, 0, own.remove == 0 ? kNowhere : -kNowhere);
}

/// Adds the batches of a plan's splats, which begin at `first` in the list.
void add_batches(std::vector<glm::uvec2>& batches, const FramePlan& plan, std::uint32_t first) {
    for (const glm::uvec2& batch : plan.batches)
        batches.emplace_back(first + batch.x, batch.y);
    if (plan.variant.culled) return;
    const std::uint32_t count = plan.params.splat_count;
    for (std::uint32_t at = 0; at < count; at += shader::SPLAT_BATCH)
        batches.emplace_back(first + at, std::min(shader::SPLAT_BATCH, count - at));
}

}  // namespace

FramePlan plan_together(std::span<const FramePlan> plans) {
    FramePlan out = plans.front();
    out.variant = variant_of_all(plans);
    for (const FramePlan& plan : plans) {
        out.depths.nearest = std::min(out.depths.nearest, plan.depths.nearest);
        out.depths.farthest = std::max(out.depths.farthest, plan.depths.farthest);
        out.depths.reach = std::max(out.depths.reach, plan.depths.reach);
        out.depths.thickness = std::min(out.depths.thickness, plan.depths.thickness);
    }
    // A tiny grid beside a large one must not need more sheets than there can be.
    out.depths.thickness = std::max(out.depths.thickness, out.depths.least_thickness());
    out.bricks.clear();
    out.label_colors.clear();
    std::vector<glm::uvec2> batches;
    std::vector<shader::VolumeParams> volumes;
    std::uint64_t examined = 0;
    std::uint32_t splats = 0;
    bool culled = false;
    for (const FramePlan& plan : plans) {
        out.depths.anchor = plan.depths.anchor;
        out.volume = plan.volume;
        place_sheets(out);
        out.volume.first_splat = splats;
        out.volume.first_label = static_cast<std::uint32_t>(out.label_colors.size());
        fill_clip(out.volume, plan.variant.clip, out.variant.clip);
        volumes.push_back(out.volume);
        add_batches(batches, plan, splats);
        out.label_colors.insert(out.label_colors.end(), plan.label_colors.begin(), plan.label_colors.end());
        out.reach = std::max(out.reach, plan.reach);
        examined += plan.splats_examined;
        splats += plan.params.splat_count;
        culled |= plan.variant.culled;
    }
    out.volume = volumes.front();
    out.together.assign(volumes.begin() + 1, volumes.end());
    out.params.volume_count = static_cast<std::uint32_t>(volumes.size());
    draw_first(out, splats);
    if (culled) draw_batches(out, std::move(batches));
    out.splats_examined = examined;
    return out;
}

}  // namespace edgesplat

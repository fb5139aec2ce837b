#include "engine/forecast/description_passes.h"

#include <algorithm>
#include <array>

#include "engine/error.h"
#include "engine/passes/1_estimate_edges.h"
#include "engine/passes/2_collect_splats.h"
#include "engine/passes/2b_occlude_ambient.h"
#include "engine/passes/2c_cast_shadows.h"
#include "engine/passes/3_select_footprints.h"
#include "engine/passes/4_mark_pixels.h"
#include "engine/passes/4_prepare_splats.h"
#include "engine/passes/4_sort_sheets.h"
#include "engine/passes/4_sort_tiles.h"
#include "engine/passes/5_draw_tiles.h"
#include "engine/passes/5_refine_pixels.h"
#include "engine/passes/6_join_surfaces.h"
#include "engine/passes/6_merge_surfaces.h"
#include "engine/passes/7_resolve.h"
#include "engine/store/splat_store.h"

namespace edgesplat {
namespace {

struct Constant {
    std::uint32_t id;
    std::string_view name;
};
constexpr std::array kConstants{
#define EDGESPLAT_SPECIALIZATION(name, id) Constant{id, #name},
    EDGESPLAT_SPECIALIZATIONS(EDGESPLAT_SPECIALIZATION)
#undef EDGESPLAT_SPECIALIZATION
};
constexpr std::string_view kPrefix = "SPEC_";
// Each id is its index: no name is missing or duplicate.
static_assert(std::ranges::all_of(kConstants, [](const Constant& c) { return &kConstants.at(c.id) == &c; }));

/// Width of a voxel in the depth of the volume's centre, pixels.
double voxel_width(const FrameRequest& request) {
    const auto& geometry = request.volume->geometry;
    const CameraFrame view = camera_frame(request.camera);
    const double depth = std::max(glm::dot(view.forward, geometry.center() - view.eye), geometry.spacing().x);
    return geometry.mean_spacing() * request.size.y / (2 * view.tan_half_y * depth);
}

class Passes {
  public:
    explicit Passes(const gpu::DeviceProfile& profile) : profile_(&profile) {}

    void add_setup(const FrameForecast& f) {
        draw_ = "setup";
        const CollectionPlan& plan = f.collection;
        if (plan.buried) add(passes::mark_buried(plan.dims, plan.params.opaque_count, plan.clip));
        if (plan.edge_field) add(passes::estimate_edges({}, estimate_inputs(plan)));
        const passes::CollectSplats collect = collect_inputs(plan);
        add(passes::count_splats(collect));
        add(passes::finish_splats(collect, 1));
    }

    /// `several_volumes`: others have matter, too.
    void add_reach(const FrameRequest& request, const FrameForecast& f, bool several_volumes) {
        const Clip& clip = request.scene.effects.clip;
        passes::SplatLight in{
            .iso_count = static_cast<std::uint32_t>(request.scene.iso_values.size()),
            .clip = {static_cast<std::uint32_t>(clip.keep.size()), static_cast<std::uint32_t>(clip.remove.size())},
            .surfaces = f.collection.surfaces,
            .transfer = !request.scene.transfer.empty()};
        const auto add_pass = [&](gpu::Pass (*pass)(const passes::SplatLight&)) {
            in.beside = false;
            add(pass(in));
            in.beside = true;
            if (several_volumes) add(pass(in));
        };
        if (f.occluded) add_pass(passes::occlude_ambient);
        if (f.shadow_lights > 0) add_pass(passes::cast_shadows);
    }

    void add_draw(const ForecastDraw& draw) {
        draw_ = draw.name;
        const FramePlan& plan = draw.plan;
        const passes::DrawVariant& variant = plan.variant;
        const auto& p = plan.params;
        if (variant.tiles) add(passes::begin_surfaces(variant, p.size));
        add(passes::select_footprints(p.slot_count, variant));
        add(passes::sort_sheets(*profile_, variant, p, 1));
        if (variant.tiles) {
            add_tiles(plan);
        } else {
            add("5_draw_splats", {{{"group_rect.vert", "5a_clear_sheets.frag"}, {}},
                                  {{"5b_draw_splats.vert", "5b_draw_splats.frag"}, passes::draw_constants(variant)}});
            add("6_composite_sheet",
                {{{"group_rect.vert", "6_composite_sheet.frag"}, {{shader::SPEC_PAYLOAD, variant.payload}}}});
        }
        if (variant.several && variant.surfaces) add_merge(plan);
        if (!variant.mixed) add(passes::resolve(variant, p.size, plan.gradient));
    }

    /// What follows the parts of a picture.
    void end_parts(const ForecastDraw& draw) {
        const FramePlan& plan = draw.plan;
        draw_ = draw.name;
        if (plan.variant.several) add_merge(plan);
        add(passes::join_surfaces(plan.variant, plan.params.size));
        add(passes::resolve(plan.variant, plan.params.size, plan.gradient));
    }

    std::vector<PassDescription> take() { return std::move(out_); }

  private:
    /// `depends`: as in PassDescription.
    void add(const char* name, std::vector<gpu::PipelineVariant> pipelines, bool depends = false) {
        // Several parts of a picture may run the same pass.
        const auto same = std::ranges::find_if(
            out_, [&](const PassDescription& pass) { return pass.draw == draw_ && pass.name == name; });
        PassDescription& pass =
            same == out_.end() ? out_.emplace_back(PassDescription{.draw = draw_, .name = name, .depends = depends})
                               : *same;
        for (gpu::PipelineVariant& pipeline : pipelines)
            if (std::ranges::none_of(pass.pipelines, [&](const gpu::PipelineVariant& known) {
                    return edgesplat::text_of(known) == edgesplat::text_of(pipeline);
                }))
                pass.pipelines.push_back(std::move(pipeline));
    }

    void add(const gpu::Pass& pass, bool depends = false) {
        if (pass.dispatches.empty()) return;
        std::vector<gpu::PipelineVariant> pipelines;
        for (const gpu::Dispatch& dispatch : pass.dispatches)
            pipelines.push_back({{dispatch.shader}, dispatch.constants});
        add(pass.name, std::move(pipelines), depends);
    }

    void add_tiles(const FramePlan& plan) {
        const passes::TileDraw how{.profile = profile_, .refined = plan.refined, .wide_marks = plan.wide_marks};
        const auto& p = plan.params;
        // In refined pictures the host plans the chunks.
        if (profile_->side_by_side && !plan.refined) add(passes::plan_chunks());
        add(passes::sort_tiles(*profile_, p, 0, 1));
        add(passes::prepare_splats(plan.variant, 0, 1));
        add(passes::mark_pixels(plan.variant, how, 1, 0));
        // No splat may need it, and splats may be too small for refined pixels.
        add(passes::trace_faces(plan.variant, how, 1, {}), true);
        add(passes::draw_tiles(plan.variant, how, {}));
        add(passes::shade_surfaces(plan.variant, how, {}));
        for (std::uint32_t step = shader::REFINE_STEP; plan.refined && step > 1; step /= 2)
            add(passes::refine_pixels(plan.variant, 1, step), true);
    }

    void add_merge(const FramePlan& plan) { add(passes::merge_surfaces(passes::Merge::Take, plan.params.size)); }

    const gpu::DeviceProfile* profile_;
    std::string draw_;  ///< that the next passes belong to
    std::vector<PassDescription> out_;
};

}  // namespace

std::vector<PassDescription> described_passes(const FrameRequest& request, const FrameForecast& forecast) {
    Passes passes(*forecast.profile);
    const std::vector<const FrameForecast*> parts = forecast_parts(forecast);
    const bool several_volumes =
        std::ranges::any_of(parts, [&](const FrameForecast* part) { return part->number != parts.front()->number; });
    for (const FrameForecast* part : parts) {
        passes.add_setup(*part);
        passes.add_reach(request, *part, several_volumes);
    }
    for (std::size_t i = 0; i < forecast.draws.size(); ++i) {
        for (const FrameForecast* part : parts)
            if (!part->draws.empty()) passes.add_draw(part->draws[i]);
        if (forecast.draws[i].plan.variant.mixed) passes.end_parts(forecast.draws[i]);
    }
    return passes.take();
}

std::vector<gpu::PipelineVariant> pipelines_of(const FrameRequest& request, FrameForecast forecast) {
    // Only wide splats are refined (should_refine); the splats' sizes are not known yet.
    for (ForecastDraw& draw : forecast.draws)
        draw.plan.refined &= voxel_width(request) >= shader::REFINE_STEP;
    std::vector<gpu::PipelineVariant> pipelines;
    for (const PassDescription& pass : described_passes(request, forecast))
        pipelines.insert(pipelines.end(), pass.pipelines.begin(), pass.pipelines.end());
    // These depend on which splats are in view.
    std::erase_if(pipelines, [](const gpu::PipelineVariant& pipeline) {
        return std::ranges::any_of(pipeline.constants, [](const auto& c) { return c.first == shader::SPEC_CULLED; });
    });
    return pipelines;
}

std::string text_of(const gpu::PipelineVariant& pipeline) {
    std::string text = fmt::format("{}", fmt::join(pipeline.shaders, ", "));
    for (const auto& [id, value] : pipeline.constants)
        text += fmt::format(" {}={}", kConstants.at(id).name.substr(kPrefix.size()), value);
    return text;
}

}  // namespace edgesplat

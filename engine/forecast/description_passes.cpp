#include "engine/forecast/description_passes.h"

#include <algorithm>
#include <array>

#include "engine/error.h"
#include "engine/passes/1_estimate_edges.h"
#include "engine/passes/2_collect_splats.h"
#include "engine/passes/2b_occlude_ambient.h"
#include "engine/passes/3_select_footprints.h"
#include "engine/passes/4_mark_pixels.h"
#include "engine/passes/4_sort_sheets.h"
#include "engine/passes/4_sort_tiles.h"
#include "engine/passes/5_draw_tiles.h"
#include "engine/passes/5_refine_pixels.h"
#include "engine/passes/7_resolve.h"
#include "engine/store/splat_store.h"

namespace edgesplat {
namespace {

/// Nanoseconds of a pass per voxel, splat, entry, sheet, fragment or pixel that it processes.
struct Rates {
    double bury_voxel, normal_voxel, edge_voxel, spline_voxel, collect_voxel, collect_splat, occlude_splat,
        shadow_splat;
    double select_splat, sort_entry, sort_sheet, draw_entry, fragment, warped_fragment, composite_pixel, resolve_pixel;
};

// Round numbers of the right order of magnitude for two processor cores; not fitted to measurements.
constexpr Rates kRates{4, 6, 60, 300, 4, 60, 5000, 4000, 30, 6, 3000, 150, 6, 25, 2, 4};
// Assumed speed of a GPU relative to two processor cores; not measured.
constexpr double kGpuFactor = 200;

/// Whether times are for the processor; true without a device.
bool on_processor(const DeviceInfo* device) {
    return device == nullptr || device->is_processor;
}

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

gpu::PipelineVariant variant(const char* shader, const gpu::Specialization& constants) {
    return {{shader}, constants};
}

/// Width of a voxel in the depth of the volume's centre, pixels.
double voxel_width(const FrameRequest& request) {
    const auto& geometry = request.volume->geometry;
    const CameraFrame view = camera_frame(request.camera);
    const double depth = std::max(glm::dot(view.forward, geometry.center() - view.eye), geometry.spacing().x);
    return geometry.mean_spacing() * request.size.y / (2 * view.tan_half_y * depth);
}

/// Estimated number of fragments that a draw shades: the splats' squares on the screen, each at most the picture.
double fragments(const FrameRequest& request, const FramePlan& plan) {
    const double across = 3.2 * voxel_width(request) + 1;
    const double pixels = static_cast<double>(request.size.x) * request.size.y;
    // A splat is drawn once per sheet that it reaches. About half of the fragments are saturated and not shaded.
    const double slices = 1 + 0.5 * (plan.sheets_per_splat - 1);
    return plan.params.splat_count * std::min(across * across, pixels) * slices / 2;
}

class Passes {
  public:
    Passes(const DeviceInfo* device, const gpu::DeviceProfile& profile)
        : milliseconds_per_(on_processor(device) ? 1e-6 : 1e-6 / kGpuFactor), profile_(&profile) {}

    void add(const char* draw, const char* name, double nanoseconds, std::vector<gpu::PipelineVariant> pipelines) {
        const double milliseconds = nanoseconds * milliseconds_per_ * again_;
        // Both parts of a mixture run it.
        const auto same = std::ranges::find_if(
            out_, [&](const PassDescription& pass) { return pass.draw == draw && pass.name == name; });
        if (same == out_.end()) {
            out_.push_back({draw, name, "", std::move(pipelines), milliseconds, {}});
            return;
        }
        same->estimated_milliseconds += milliseconds;
        for (gpu::PipelineVariant& pipeline : pipelines)
            if (std::ranges::find(same->pipelines, text_of(pipeline), text_of) == same->pipelines.end())
                same->pipelines.push_back(std::move(pipeline));
    }

    void add_setup(const FrameForecast& f) {
        const CollectionPlan& plan = f.collection;
        const glm::dvec3 dims(plan.dims);
        const double voxels = dims.x * dims.y * dims.z, splats = static_cast<double>(f.splats.extent.count);
        if (plan.buried) {
            std::vector<gpu::PipelineVariant> axes;
            for (std::uint32_t axis = 0; axis < 3; ++axis)
                axes.push_back(
                    variant("1a_mark_buried.comp", passes::mark_constants(axis, plan.params.opaque_count, plan.clip)));
            add("setup", "1a_mark_buried", kRates.bury_voxel * voxels, axes);
        }
        if (plan.edge_field) {
            const double rate = plan.estimator == EdgeEstimator::Off     ? kRates.normal_voxel
                                : plan.estimator == EdgeEstimator::Cubic ? kRates.spline_voxel
                                                                         : kRates.edge_voxel;
            add("setup", "1_estimate_edges", kRates.normal_voxel * voxels + rate * 3 * splats,
                {variant("1b_estimate_edges.comp", passes::estimate_constants(estimate_inputs(plan)))});
        }
        const passes::CollectSplats collect = collect_inputs(plan);
        std::vector<gpu::PipelineVariant> shaders{variant("2_collect_splats.comp", passes::collect_constants(collect))};
        if (collect.edges) shaders.push_back(variant("2a_finish_splats.comp", passes::finish_constants(collect)));
        add("setup", "2_collect_splats", kRates.collect_voxel * voxels + kRates.collect_splat * splats, shaders);
    }

    void add_reach(const FrameRequest& request, const FrameForecast& f) {
        const double splats = static_cast<double>(f.splats.extent.count);
        const Clip& clip = request.scene.effects.clip;
        const passes::SplatLight in{
            .iso_count = static_cast<std::uint32_t>(request.scene.iso_values.size()),
            .clip = {static_cast<std::uint32_t>(clip.keep.size()), static_cast<std::uint32_t>(clip.remove.size())},
            .surfaces = f.collection.surfaces,
            .transfer = !request.scene.transfer.empty()};
        const auto add_pass = [&](const char* pass, const char* shader, double milliseconds) {
            add("setup", pass, milliseconds, {variant(shader, passes::light_constants(in))});
            if (f.draws.front().plan.variant.several) {
                passes::SplatLight beside = in;
                beside.beside = true;
                add("setup", pass, milliseconds, {variant(shader, passes::light_constants(beside))});
            }
        };
        if (f.occluded) add_pass("2b_occlude_ambient", "2b_occlude_ambient.comp", kRates.occlude_splat * splats);
        if (f.shadow_lights > 0)
            add_pass("2c_cast_shadows", "2c_cast_shadows.comp",
                     kRates.shadow_splat * splats * static_cast<double>(f.shadow_lights));
    }

    std::vector<gpu::PipelineVariant> sort_sheets_shaders(const passes::DrawVariant& drawn) const {
        std::vector<gpu::PipelineVariant> shaders;
        for (const passes::SortStep& step : passes::sort_sheets_steps(drawn, *profile_))
            shaders.push_back(variant(step.shader, step.constants));
        return shaders;
    }

    void add_draw(const FrameRequest& request, const ForecastDraw& draw) {
        const FramePlan& plan = draw.plan;
        const auto& p = plan.params;
        const double splats = p.splat_count, pixels = static_cast<double>(p.size.x) * p.size.y;
        const double entries = splats * (plan.variant.sliced ? 0.6 * plan.sheets_per_splat : 1);
        const char* name = draw.name.c_str();
        const int samples = plan.variant.payload == shader::PAYLOAD_COLOR ? request.scene.effects.samples : 1;
        again_ = samples * samples;
        const bool warped = plan.variant.footprints != FootprintMode::Isotropic;
        const double drawing = kRates.draw_entry * entries +
                               (warped ? kRates.warped_fragment : kRates.fragment) * fragments(request, plan);
        if (plan.variant.begins)
            add(name, "5_begin_surfaces", kRates.resolve_pixel * pixels,
                {variant("5_begin_surfaces.comp", passes::begin_constants(plan.variant))});
        add(name, "3_select_footprints", kRates.select_splat * splats,
            {variant("3_select_footprints.comp", passes::select_constants(plan.variant))});
        add(name, "4_sort_sheets", kRates.sort_entry * (splats + entries) + kRates.sort_sheet * p.sheet_count,
            sort_sheets_shaders(plan.variant));
        if (plan.variant.tiles) {
            std::vector<gpu::PipelineVariant> sorting;
            for (const char* shader : passes::sort_tiles_shaders(*profile_, plan.refined))
                sorting.push_back(variant(shader, {}));
            add(name, "4_sort_tiles", kRates.sort_entry * 2 * entries, sorting);
            add(name, "4_prepare_splats", kRates.draw_entry * entries,
                {variant("4g_prepare_splats.comp", passes::draw_constants(plan.variant))});
            add(name, "4_mark_pixels", kRates.draw_entry * entries,
                {variant(
                    "4h_mark_pixels.comp",
                    passes::mark_pixels_constants(
                        plan.variant, {.profile = profile_, .refined = plan.refined, .wide_marks = plan.wide_marks}))});
            if (plan.variant.traced) {
                add(name, "5_trace_faces", kRates.draw_entry * entries,
                    {variant("5_trace_faces.comp",
                             passes::trace_constants(
                                 plan.variant,
                                 {.profile = profile_, .refined = plan.refined, .wide_marks = plan.wide_marks}))});
                out_.back().depends = true;
            }
            const gpu::Specialization tiles = passes::tile_constants(
                plan.variant, {.profile = profile_, .refined = plan.refined, .wide_marks = plan.wide_marks});
            if (plan.variant.surfaces) {
                add(name, "5_draw_surfaces", drawing, {variant("5_draw_surfaces.comp", tiles)});
                add(name, "5_shade_surfaces", kRates.resolve_pixel * pixels, {variant("5_shade_surfaces.comp", tiles)});
            } else {
                add(name, "5_draw_tiles", drawing, {variant("5_draw_tiles.comp", tiles)});
            }
            // The pass is skipped if the splats turn out to be small.
            if (plan.refined) {
                std::vector<gpu::PipelineVariant> steps;
                for (std::uint32_t step = shader::REFINE_STEP; step > 1; step /= 2)
                    steps.push_back(variant("5_refine_pixels.comp", passes::refine_constants(plan.variant, step)));
                add(name, "5_refine_pixels", kRates.composite_pixel * pixels, steps);
                out_.back().depends = true;
            }
        } else {
            add(name, "5_draw_splats", drawing,
                {{{"group_rect.vert", "5a_clear_sheets.frag"}, {}},
                 {{"5b_draw_splats.vert", "5b_draw_splats.frag"}, passes::draw_constants(plan.variant)}});
            add(name, "6_composite_sheet", kRates.composite_pixel * pixels * p.sheet_count / 2,
                {{{"group_rect.vert", "6_composite_sheet.frag"}, {{shader::SPEC_PAYLOAD, plan.variant.payload}}}});
        }
        if (plan.variant.several && plan.variant.surfaces) add_merge(draw);
        if (!plan.variant.mixed)
            add(name, "7_resolve", kRates.resolve_pixel * pixels,
                {variant("7_resolve.comp", passes::resolve_constants(plan.variant, plan.gradient))});
    }

    /// What follows the parts of a picture.
    void end_parts(const ForecastDraw& draw) {
        const FramePlan& plan = draw.plan;
        const double milliseconds = kRates.resolve_pixel * plan.params.size.x * plan.params.size.y;
        const char* name = draw.name.c_str();
        if (plan.variant.several) add_merge(draw);
        add(name, "6_join_surfaces", milliseconds, {variant("6_join_surfaces.comp", {})});
        add(name, "7_resolve", milliseconds,
            {variant("7_resolve.comp", passes::resolve_constants(plan.variant, plan.gradient))});
    }

    std::vector<PassDescription> take() { return std::move(out_); }

  private:
    void add_merge(const ForecastDraw& draw) {
        const glm::ivec2& size = draw.plan.params.size;
        add(draw.name.c_str(), "6_merge_surfaces", kRates.resolve_pixel * size.x * size.y,
            {variant("6_merge_surfaces.comp", {})});
    }

    double milliseconds_per_;
    const gpu::DeviceProfile* profile_;
    int again_ = 1;  ///< number of runs of each pass
    std::vector<PassDescription> out_;
};

}  // namespace

std::vector<PassDescription> described_passes(const FrameRequest& request, const FrameForecast& forecast,
                                              const DeviceInfo* device) {
    Passes passes(device, *forecast.profile);
    const std::vector<const FrameForecast*> parts = forecast_parts(forecast);
    for (const FrameForecast* part : parts) {
        passes.add_setup(*part);
        passes.add_reach(request, *part);
    }
    for (std::size_t i = 0; i < forecast.draws.size(); ++i) {
        for (const FrameForecast* part : parts)
            passes.add_draw(request, part->draws[i]);
        if (parts.size() > 1) passes.end_parts(forecast.draws[i]);
    }
    return passes.take();
}

std::vector<gpu::PipelineVariant> pipelines_of(const FrameRequest& request, FrameForecast forecast) {
    // Only wide splats are refined (should_refine); the splats' sizes are not known yet.
    for (ForecastDraw& draw : forecast.draws)
        draw.plan.refined &= voxel_width(request) >= shader::REFINE_STEP;
    std::vector<gpu::PipelineVariant> pipelines;
    for (const PassDescription& pass : described_passes(request, forecast, nullptr))
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

std::string estimate_basis(const DeviceInfo* device) {
    std::string text =
        "estimates: from round numbers of nanoseconds per voxel, splat, sheet entry, fragment and pixel on two "
        "processor cores; they rank the passes, but may be wrong by a factor of several";
    return on_processor(device) ? text
                                : text + fmt::format("; divided by {:g} for a GPU (assumed, not measured)", kGpuFactor);
}

}  // namespace edgesplat

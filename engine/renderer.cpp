#include "engine/renderer.h"

#include <algorithm>
#include <chrono>

#include "engine/error.h"
#include "engine/image/sample_mean.h"
#include "engine/overlays/overlays.h"
#include "engine/plan/resource_table.h"
#include "engine/renderer/state.h"
#include "engine/volume/filters.h"
#include "footprints/kernel.h"
#include "footprints/paper_warp.h"

namespace edgesplat {
namespace {

/// Channels [first, first + count) of the RGBA picture in `pixels`.
Image take(std::span<const float> pixels, const glm::ivec2& size, int first, int count) {
    Image image(size.x, size.y, count);
    for (std::size_t i = 0; i < image.pixels.size() / static_cast<std::size_t>(count); ++i) {
        for (int c = 0; c < count; ++c) {
            image.pixels[i * static_cast<std::size_t>(count) + static_cast<std::size_t>(c)] =
                pixels[4 * i + static_cast<std::size_t>(first + c)];
        }
    }
    return image;
}

}  // namespace

RendererState::RendererState(const DeviceChoice& choice) : DeviceState(choice), opened_as(choice) {
    for (const TargetBufferRow& row : target_buffer_rows())
        if (row.always) targets.*row.buffer = gpu::Buffer(device, row.bytes({}, device.profile()), row.place, row.text.name);
    std::ranges::copy(passes::quad_indices(), targets.indices.mapped<std::uint32_t>(targets.indices.bytes() / sizeof(std::uint32_t)).begin());
    bindings.write(volume_resources, targets);
    commands.run([&] { bindings.prepare(commands); });
}

void upload_volume(RendererState& state) {
    const auto field = scaled_field(*state.volume);
    const VolumeImageRow& row = row_of(&VolumeResources::volume);
    auto& image = state.volume_resources.volume;
    image = gpu::GpuImage(state.device, shape_of(row, state.volume->geometry.dims), row.text.name);
    upload_image(state.commands, state.device, image, field.data(), sizeof(float));
}

double RendererState::collect(const Scene& scene, const Settings& settings, bool keep_buried) {
    const CollectionPlan wanted = plan_collection(*volume, scene, settings, keep_buried);
    const auto start = Clock::now();
    collection_times.clear();
    const bool anew = changed || !collected || *collected != wanted;
    // The spline's coefficients depend on all samples.
    if (changed && collected == wanted && !wanted.takes_coefficients())
        collect_changes();
    else if (anew)
        collect_anew(wanted);
    const bool occluded_anew = occlude(scene), shadowed_anew = cast_shadows(scene, settings);
    return anew || occluded_anew || shadowed_anew ? milliseconds_since(start) : 0;
}

void RendererState::collect_changes() {
    const CollectionPlan plan_kept = *collected;
    const VoxelBox box = *changed;
    collected.reset();
    occluded.reset();
    shadowed.reset();
    volume_resources.occlusion = {};
    volume_resources.shadows = {};
    collection_times = renew_collection(device, commands, bindings, plan_kept, box, volume_resources);
    if (plan_kept.edge_field) voxels_estimated += voxels_that_depend_on(box, plan_kept.dims);
    collected = plan_kept;
    changed.reset();
}

void RendererState::collect_anew(const CollectionPlan& wanted) {
    collected.reset();
    occluded.reset();
    shadowed.reset();
    volume_resources.occlusion = {};
    volume_resources.shadows = {};
    if (wanted.takes_coefficients()) provide_coefficients();
    collection_times = run_collection(device, commands, bindings, wanted, volume_resources);
    if (wanted.edge_field) voxels_estimated += volume->geometry.voxel_count();
    collected = wanted;
    changed.reset();
}

bool RendererState::provide_coefficients() {
    if (volume_resources.coefficients) return false;
    const glm::ivec3 dims = volume->geometry.dims;
    const auto coefficients = bspline_coefficients(scaled_field(*volume), dims);
    const VolumeImageRow& row = row_of(&VolumeResources::coefficients);
    volume_resources.coefficients = gpu::GpuImage(device, shape_of(row, dims), row.text.name);
    upload_image(commands, device, volume_resources.coefficients, coefficients.data(), sizeof(float));
    return true;
}

void RendererState::release_unused(const Settings& drawn) {
    const bool estimates = draws_warped(drawn) && drawn.edges == EdgeEstimator::Cubic;
    if (!estimates && !(raycast && raycast->takes_coefficients())) volume_resources.coefficients = {};
}

FramePlan RendererState::plan_picture(const Scene& scene, const Camera& camera, const Settings& settings,
                                      const glm::ivec2& size, std::uint32_t payload) const {
    const double reach = kernel_reach(settings);
    FramePlan out =
        plan_frame(*volume, scene, camera, settings, size, payload, volume_resources.splat_count,
                   volume_resources.box_low, volume_resources.box_high, reach, volume_resources.crease_splat_count > 0);
    // Parts of a picture that several devices draw agree.
    if (!device.profile().refines && exchange == nullptr) out.refined = out.may_refine = false;
    if (culls) cull_bricks(out, volume_resources.bricks, {volume->geometry, camera, size, out.variant.antialias});
    return out;
}

void RendererState::draw(const Scene& scene, const Camera& camera, const Settings& settings, const glm::ivec2& size,
                         std::uint32_t payload, const glm::dvec2& offset) {
    plan = plan_picture(scene, camera, settings, size, payload);
    if (offset != glm::dvec2(0)) shift_rays(plan, offset);
    if (opened_as.check_numbers) check_splats();
    draw_planned();
    if (opened_as.check_numbers) check_picture();
}

void RendererState::draw_planned() {
    provide_targets(plan);
    if (!plan.variant.tiles) {
        draw_times = draw_sheets(commands, plan, targets);
        return;
    }
    const passes::TileDraw how{.profile = &device.profile(), .count = counting, .part = exchange != nullptr};
    if (exchange) return draw_part(how);
    draw_times.clear();
    if (draw_front_first(how)) return;
    const Chunks chunks = sort_frame(commands, plan, targets);
    add_times(draw_times, commands.span_times());
    plan.refined = plan.refined && worth_refining(chunks);
    draw_chunks(chunks, how);
}

void RendererState::draw_chunks(const Chunks& chunks, const passes::TileDraw& how) {
    provide_chunks(chunks);
    std::function<void()> between;
    if (interruption) between = [this] { heed_interruption(); };
    add_times(draw_times,
              draw_tiles(commands, plan, targets, static_cast<std::uint32_t>(chunks.parts.size()), how, between));
}

Renderer::Renderer(const DeviceChoice& choice) : state_(open_state(choice, 2)) {}

Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

const DeviceInfo& Renderer::device() const {
    return state_->device.info();
}

std::uint64_t Renderer::validation_messages() const {
    return state_->messages_before + state_->device.validation_messages();
}

void Renderer::set_volume(std::shared_ptr<const Volume> volume) {
    auto& self = *state_;
    if (self.take_changes(volume)) return;
    self.changed.reset();
    self.drop_targets();
    self.levels.clear();
    self.other = {};
    self.original = std::move(volume);
    self.volume.reset();
    if (self.original) self.use_level(0);
}

void Renderer::set_patience(double milliseconds) {
    state_->patience = milliseconds;
}

void Renderer::set_interruption(std::function<bool()> wanted) {
    state_->interruption = std::move(wanted);
}

void Renderer::set_memory_budget(std::uint64_t bytes) {
    state_->memory_budget = bytes;
    state_->checked.clear();
}

RenderResult Renderer::render(const Scene& scene, const Camera& camera, const Settings& wanted, int width, int height,
                              const AovRequest& aovs) {
    if (!state_->original) fail("render: no volume has been set");
    if (width < 1 || height < 1 || width > 16384 || height > 16384) {
        fail("size: {}x{}, expected 1 to 16384 pixels per side", width, height);
    }
    validate(scene);
    validate(wanted);
    state_->need_layers(scene, wanted);
    if (state_->exchange && drawn_as(wanted, scene).sheet_format != SheetFormat::Tiles)
        fail("sheets that are drawn in parts need --sheet-format tiles");
    if (scene.effects.smooth_outlines && drawn_as(wanted, scene).sheet_format != SheetFormat::Tiles)
        fail("effects.smooth_outlines: pixels of sheets in layers do not know outlines, expected --sheet-format tiles");
    if (scene.effects.smooth_outlines && state_->exchange)
        fail("effects.smooth_outlines: a part of the sheets does not know the outlines of the others, expected false");
    return draw_again_if_lost([&] { return render_once(scene, camera, wanted, width, height, aovs); });
}

RenderResult Renderer::render_once(const Scene& scene, const Camera& camera, const Settings& wanted, int width,
                                   int height, const AovRequest& aovs) {
    auto& self = *state_;
    const Settings settings = drawn_as(wanted, scene);
    const glm::ivec2 size(width, height);
    RenderResult result;
    self.release_unused(settings);
    self.device.forget_peaks();
    const std::uint64_t submissions_before = self.commands.submissions();
    const gpu::PipelineCreation made = self.pipelines.creation();
    self.voxels_estimated = 0;
    self.provide_splats({self.original, scene, camera, wanted, size, aovs}, result.stats);
    result.stats.voxels_estimated = self.voxels_estimated;
    if (result.stats.setup_milliseconds > 0) result.stats.passes = self.collection_times;

    const auto pixels = [&] {
        return std::span<const float>(
            self.targets.output.mapped<float>(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4));
    };
    const auto start = Clock::now();
    std::vector<PassTime> times;
    SampleMean mean(size);
    self.share = {};
    for (const glm::dvec2& offset : sample_offsets(scene.effects.samples)) {
        self.heed_interruption();
        self.draw(scene, camera, settings, size, shader::PAYLOAD_COLOR, offset);
        add_times(times, self.draw_times);
        self.add_counts(result.stats);
        if (scene.effects.samples > 1) mean.add(pixels());
    }
    result.stats.frame_milliseconds = milliseconds_since(start);
    if (self.exchange) result.stats.share = self.share;
    result.stats.passes.insert(result.stats.passes.end(), times.begin(), times.end());
    result.stats.splats_drawn = self.targets.drawn.mapped<std::uint32_t>(1)[0];
    result.stats.sheets = self.plan.params.sheet_count;
    result.stats.sheet_groups = self.plan.params.group_count;
    result.color = scene.effects.samples > 1 ? mean.image() : take(pixels(), size, 0, 4);

    const auto draw_output = [&](const char* name, std::uint32_t payload) {
        self.draw(scene, camera, settings, size, payload);
        for (const PassTime& pass : self.draw_times)
            result.stats.passes.push_back({std::string(name) + ": " + pass.name, pass.milliseconds});
    };
    if (aovs.tau) {
        draw_output("tau", shader::PAYLOAD_TAU);
        result.tau = take(pixels(), size, 3, 1);
    }
    if (aovs.depth || aovs.distance) {
        draw_output("depth, distance", shader::PAYLOAD_DEPTH_DISTANCE);
        if (aovs.depth) result.depth = take(pixels(), size, 0, 1);
        if (aovs.distance) result.distance = take(pixels(), size, 1, 1);
    }
    if (aovs.normal) {
        draw_output("normal", shader::PAYLOAD_NORMAL);
        result.normal = take(pixels(), size, 0, 3);
    }
    result.stats.submissions = self.commands.submissions() - submissions_before;
    result.stats.pipelines_made = self.pipelines.creation().count - made.count;
    result.stats.pipeline_milliseconds = self.pipelines.creation().milliseconds - made.milliseconds;
    if (scene.effects.overlays.any()) draw_overlays(result.color, *self.volume, scene, camera);
    result.stats.device = self.device.info();
    result.stats.voxels = self.volume->geometry.voxel_count();
    result.stats.splats_collected = self.volume_resources.splat_count;
    // What is looked at twice has been looked at.
    result.stats.splats_culled =
        self.volume_resources.splat_count - std::min(self.plan.looked_at, self.volume_resources.splat_count);
    result.stats.edge_splats = self.volume_resources.edge_splat_count;
    result.stats.device_bytes = self.device.allocated_bytes();
    for (const auto& [name, allocation] : self.device.allocations())
        if (!name.empty()) result.stats.memory.push_back({name, allocation.peak});
    result.stats.validation_messages = validation_messages();
    return result;
}

}  // namespace edgesplat

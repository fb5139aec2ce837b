#include "engine/renderer.h"

#include <algorithm>
#include <map>

#include "engine/clock.h"
#include "engine/error.h"
#include "engine/image/sample_mean.h"
#include "engine/overlays/overlays.h"
#include "engine/renderer/state.h"
#include "engine/scene/mixture.h"
#include "engine/scene/transfer_function.h"
#include "engine/volume/packed_volume.h"
#include "footprints/kernel.h"

namespace edgesplat {
namespace {

/// Extracts channels [first, first + count) of an RGBA picture.
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

void add_counts(const PictureCounts& counts, RenderStats& stats) {
    stats.dirty_share = counts.dirty_share;
    if (!counts.draws) return;
    DrawCounts& sum = stats.draw_counts ? *stats.draw_counts : stats.draw_counts.emplace();
    sum.vertices += counts.draws->vertices;
    sum.fragments += counts.draws->fragments;
    sum.shaded += counts.draws->shaded;
}

}  // namespace

std::optional<Image> RenderResult::*image_of(const Aov& aov) {
    static const std::map<std::string_view, std::optional<Image> RenderResult::*> images{
        {"tau", &RenderResult::tau},
        {"depth", &RenderResult::depth},
        {"normal", &RenderResult::normal},
        {"distance", &RenderResult::distance}};
    return images.at(aov.name);
}

Renderer::Renderer(const DeviceChoice& choice) : state_(open_state(choice, 2)) {}

Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

const DeviceInfo& Renderer::device() const {
    return state_->session.device().info();
}

std::uint64_t Renderer::validation_messages() const {
    return state_->session.validation_messages();
}

void Renderer::set_volume(std::shared_ptr<const Volume> volume) {
    state_->splats.set_volume(std::move(volume));
}

void Renderer::set_patience(double milliseconds) {
    state_->options.patience = milliseconds;
}

void Renderer::set_progress(std::function<void(double share)> report) {
    state_->options.progress = std::move(report);
}

void Renderer::set_interruption(std::function<bool()> wanted) {
    state_->options.interruption = std::move(wanted);
}

void Renderer::set_memory_budget(std::uint64_t bytes) {
    state_->options.memory_budget = bytes;
    state_->splats.forget_checked();
}

void Renderer::count_fragments(bool on) {
    state_->options.counting = on;
    state_->session.commands().count_draws(on);
}

FrameForecast Renderer::forecast(const FrameRequest& request) {
    require_samples(*request.volume, "a forecast of the frame");
    const auto count = [&](const FrameRequest& part, const CollectionPlan& wanted) {
        const auto known = state_->splats.collected_splats(part, wanted);
        return known ? *known : count_splats_of(part, wanted);
    };
    return forecast_frame(request, count, state_->session.profile());
}

std::vector<FittingChange> Renderer::fitting_changes(const FrameRequest& request) const {
    return edgesplat::fitting_changes(state_->session.device(), request, state_->options.memory_budget);
}

std::uint64_t Renderer::held_bytes() const {
    return state_->session.device().allocated_bytes();
}

std::uint64_t Renderer::required_bytes(const PlannedResource& resource) const {
    const gpu::Device& device = state_->session.device();
    if (!resource.image) return gpu::Buffer::required_bytes(device, resource.bytes);
    return gpu::exceeds_limits(device, *resource.image).empty() ? gpu::required_bytes(device, *resource.image)
                                                                : resource.bytes;
}

RenderResult Renderer::render(const Scene& scene, const Camera& camera, const Settings& wanted, int width, int height,
                              const AovRequest& aovs) {
    if (!state_->splats.original()) fail("render: no volume has been set");
    if (width < 1 || height < 1 || width > 16384 || height > 16384) {
        fail("size: {}x{}, expected 1 to 16384 pixels per side", width, height);
    }
    validate(scene);
    validate(wanted);
    need_layers(state_->session.device(), scene, wanted);
    if (scene.effects.smooth_outlines && canonical_settings(wanted, scene).sheet_format != SheetFormat::Tiles)
        fail("effects.smooth_outlines: sheets in layers do not store outlines, expected --sheet-format tiles");
    return draw_again_if_lost([&] { return render_once(scene, camera, wanted, width, height, aovs); });
}

RenderResult Renderer::render_once(const Scene& scene, const Camera& camera, const Settings& wanted, int width,
                                   int height, const AovRequest& aovs) {
    RendererState& self = *state_;
    PictureDrawer& drawer = self.drawer;
    const gpu::Device& device = self.session.device();
    const gpu::Commands& commands = self.session.commands();
    const gpu::Pipelines& pipelines = self.session.pipelines();
    const Settings settings = canonical_settings(wanted, scene);
    const glm::ivec2 size(width, height);
    RenderResult result;
    RenderStats& stats = result.stats;
    self.splats.release_unused(settings);
    device.forget_peaks();
    const std::uint64_t submissions_before = commands.submissions();
    const gpu::PipelineCreation made = pipelines.creation();
    // Optical depth needs all voxels; surface splats are some. So it is drawn from a list of its own.
    AovRequest outputs = aovs;
    const bool tau_apart = aovs.tau && scene.added.empty() &&
                           (draws_surfaces(settings, scene, *self.splats.original()) ||
                            mixture_of(settings, scene, *self.splats.original()));
    outputs.tau = outputs.tau && !tau_apart;
    FrameRequest request{self.splats.original(), scene, camera, wanted, size, outputs};
    self.splats.provide(request, stats);
    const LevelStore& level = self.splats.level();
    self.splats.show_levels(request);
    const std::vector<FrameRequest> parts =
        level.volume.in_blocks() ? std::vector<FrameRequest>{request} : drawn_parts(request);
    const auto draw = [&](std::uint32_t payload, const glm::dvec2& offset) {
        std::vector<PicturePart> planned;
        for (const FrameRequest& part : parts) {
            const CollectedSplats list = self.splats.list_of(part);
            planned.push_back({list, drawer.plan(list, part.scene, camera, drawn_settings(part), size, payload)});
            if (offset != glm::dvec2(0)) shift_rays(planned.back().plan, offset);
        }
        if (parts.size() == 1) return drawer.draw(planned.front().list, std::move(planned.front().plan));
        drawer.draw_parts(std::move(planned), are_of_several_volumes(parts));
    };

    const auto start = Clock::now();
    std::vector<PassTime> times;
    SampleMean mean(size);
    for (const glm::dvec2& offset : sample_offsets(scene.effects.samples)) {
        self.options.throw_if_interrupted();
        draw(shader::PAYLOAD_COLOR, offset);
        add_times(times, drawer.times());
        if (self.options.counting) add_counts(drawer.counts(), stats);
        if (scene.effects.samples > 1) mean.add(floats(drawer.pixels()));
    }
    stats.frame_milliseconds = milliseconds_since(start);
    stats.passes.insert(stats.passes.end(), times.begin(), times.end());
    stats.splats_drawn = drawer.splats_drawn();
    stats.sheets = drawer.drawn().params.sheet_count;
    stats.sheet_groups = drawer.drawn().params.group_count;
    result.color = scene.effects.samples > 1 ? mean.image() : take(floats(drawer.pixels()), size, 0, 4);

    const auto take_output = [&](std::uint32_t payload) {
        for (const PassTime& pass : drawer.times())
            stats.passes.push_back({payload_name(payload) + ": " + pass.name, pass.milliseconds});
        for (const Aov& aov : edgesplat::aovs())
            if (aovs.*aov.wanted && aov.payload == payload)
                result.*image_of(aov) = take(floats(drawer.pixels()), size, aov.first, aov.count());
    };
    for (const std::uint32_t payload : payloads_of(outputs))
        if (payload != shader::PAYLOAD_COLOR) {
            draw(payload, {0, 0});
            take_output(payload);
        }
    if (tau_apart) {
        request.volume = self.splats.original();
        request.outputs = aovs;
        self.splats.provide(request, stats);
        drawer.draw(level.all(), drawer.plan(level.all(), scene, camera, settings, size, shader::PAYLOAD_TAU));
        take_output(shader::PAYLOAD_TAU);
    }
    const Volume& volume = *level.volume.volume();
    if (scene.effects.overlays.any()) draw_overlays(result.color, volume, scene, camera);
    stats.submissions = commands.submissions() - submissions_before;
    stats.pipelines_made = pipelines.creation().count - made.count;
    stats.pipeline_milliseconds = pipelines.creation().milliseconds - made.milliseconds;
    stats.device = device.info();
    for (std::size_t number = 0; number <= request.scene.added.size(); ++number) {
        const LevelStore& one = self.splats.level(number);
        stats.voxels += one.volume.volume()->geometry.voxel_count();
        for (const SplatStore* list : {&one.splats, &one.surfaces}) {
            stats.splats_collected += list->lists().splat_count;
            stats.edge_splats += list->lists().edge_splat_count;
        }
    }
    // Two rounds may examine the same splat, so the count is clamped.
    stats.splats_culled = stats.splats_collected - std::min(drawer.splats_examined(), stats.splats_collected);
    stats.device_bytes = device.allocated_bytes();
    for (const auto& [name, allocation] : device.allocations())
        if (!name.empty()) stats.memory.push_back({name, allocation.peak});
    stats.validation_messages = validation_messages();
    return result;
}

}  // namespace edgesplat

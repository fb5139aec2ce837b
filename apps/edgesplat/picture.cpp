#include "apps/edgesplat/picture.h"

#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <memory>

#include "apps/edgesplat/cpu_renderers.h"
#include "apps/edgesplat/max_error_option.h"
#include "apps/edgesplat/progress_bar.h"
#include "apps/edgesplat/renderer_option.h"
#include "apps/edgesplat/volume_options.h"
#include "engine/accuracy/json_text.h"
#include "engine/error.h"
#include "engine/overlays/overlays.h"
#include "engine/plan/plan.h"
#include "engine/scene/scene_file.h"
#include "engine/volume/analytic_volumes.h"
#include "engine/volume/packed_volume.h"
#include "engine/volume/value_text.h"

namespace {

constexpr std::array<std::string_view, 2> kPictureExtensions{".png", ".exr"};
constexpr std::array<std::string_view, 1> kJsonExtensions{".json"};

/// Checks the outputs and the scene before anything is computed.
void check(const PictureRequest& request) {
    const edgesplat::OutputChoice& output = request.document.output;
    if (!output.file.empty()) edgesplat::check_output_path(output.file, kPictureExtensions);
    if (!request.json.empty()) edgesplat::check_output_path(request.json, kJsonExtensions);
    if (edgesplat::is_png_path(output.file))
        for (const std::string& aov : output.aovs)
            edgesplat::check_output_path(aov_path(output.file, aov));
    if (request.explain.explain && output.renderer != edgesplat::RendererKind::Splat)
        edgesplat::fail("--explain needs --renderer splat");
    if (output.renderer == edgesplat::RendererKind::Raycast && !output.aovs.empty())
        edgesplat::fail("--renderer {} has no extra outputs", name_of(output.renderer));
    check_cpu_request(request.document);
    if (request.document.quality.max_error && output.renderer != edgesplat::RendererKind::Splat)
        edgesplat::fail("--max-error needs --renderer splat");
    edgesplat::validate(request.document.quality.settings);
    const auto problems = problems_of(request.document, request.folders);
    if (problems.empty()) return;
    std::string text;
    for (const edgesplat::DocumentProblem& problem : problems)
        text += fmt::format("{}{}: {}", text.empty() ? "" : "\n", problem.path, problem.text);
    edgesplat::fail("{}", text);
}

edgesplat::Volume load(PictureRequest& request) {
    edgesplat::Volume volume = load_with_progress(request.document, request.folders, request.quiet);
    if (volume.non_finite_count > 0 && !request.quiet)
        fmt::print(stderr, "edgesplat: warning: {}: {} of {} samples contain no data; they are transparent\n",
                   volume.name, volume.non_finite_count, volume.geometry.voxel_count());
    const auto& materials = request.document.materials;
    if (volume.is_label_mask() && !materials.empty() && materials.front().color && !request.quiet)
        fmt::print(stderr, "edgesplat: all {} labels have the colour of --color instead of their own\n",
                   volume.shown_labels->largest.size());
    return volume;
}

/// Renders the requested frames: for comparisons the plain one first, then the ray caster's.
std::vector<RenderedFrame> render_frames(const edgesplat::OutputChoice& output, const edgesplat::Settings& settings,
                                         edgesplat::Renderer& renderer, const edgesplat::Scene& scene,
                                         const edgesplat::Camera& camera, bool quiet) {
    std::vector<RenderedFrame> frames;
    if (output.compare_plain) {
        edgesplat::Settings plain = settings;
        plain.edges = edgesplat::EdgeEstimator::Off;
        frames.push_back({"plain", plain, {}});
    }
    if (output.compare_raycast) frames.push_back({"raycast", settings, {}, true});
    const bool edges = settings.edges != edgesplat::EdgeEstimator::Off;
    frames.push_back({edges ? "edges" : "plain", settings, {}});
    const edgesplat::AovRequest aovs = edgesplat::aov_request(output.aovs);
    const glm::ivec2& size = output.size;
    for (RenderedFrame& frame : frames) {
        ProgressLine line(quiet);
        renderer.set_progress([&line](double share) { line.update(share, "finding surfaces"); });
        frame.result = frame.rays || output.renderer == edgesplat::RendererKind::Raycast
                           ? renderer.raycast(scene, camera, frame.settings, raycast_settings(output), size.x, size.y)
                           : renderer.render(scene, camera, frame.settings, size.x, size.y, aovs);
    }
    renderer.set_progress({});
    return frames;
}

/// The volume's path as the picture records it: as written if it leads to the volume from the working folder or
/// EDGESPLAT_VOLUMES, otherwise relative to the picture's folder.
std::string recorded_path(const PictureRequest& request, const std::string& written) {
    if (edgesplat::is_builtin(written) || std::filesystem::path(written).is_absolute()) return written;
    const std::string found = edgesplat::find_volume(written, request.folders);
    try {
        if (edgesplat::find_volume(written, edgesplat::volume_folders({})) == found) return written;
    } catch (const edgesplat::Error&) {
        // Not found from the working folder: use the picture's folder.
    }
    const std::filesystem::path folder = std::filesystem::path(request.document.output.file).parent_path();
    return std::filesystem::proximate(found, folder.empty() ? "." : folder).string();
}

/// Another file of the scene in the same way.
std::string recorded_file(const PictureRequest& request, const std::string& written) {
    namespace fs = std::filesystem;
    if (written.empty() || fs::path(written).is_absolute() || fs::exists(written)) return written;
    const fs::path folder = fs::path(request.document.output.file).parent_path();
    return fs::proximate(edgesplat::find_file(written, request.folders), folder.empty() ? "." : folder).string();
}

/// Text of the drawn scene, with nothing left open, for the picture's metadata.
std::string scene_of_picture(const PictureRequest& request, const edgesplat::Volume& volume,
                             const edgesplat::Scene& scene, const edgesplat::Camera& camera,
                             const edgesplat::Settings& settings) {
    edgesplat::SceneDocument document = resolved(request.document, volume, scene, camera, settings);
    const auto record = [&](edgesplat::VolumeSource& recorded) {
        recorded.path = recorded_path(request, recorded.path);
        for (std::string* file : recorded.other_files())
            *file = recorded_file(request, *file);
    };
    record(document.volume);
    for (edgesplat::SceneDocument& entry : document.volumes)
        record(entry.volume);
    return scene_text(document);
}

/// Warns about an eye inside opaque matter, which occludes everything else.
void warn_about_eye(const edgesplat::Volume& volume, const edgesplat::Camera& camera) {
    const glm::ivec3 voxel(glm::round(volume.geometry.to_index(camera.eye)));
    fmt::print(stderr,
               "edgesplat: warning: the eye ({:.5g}, {:.5g}, {:.5g} mm) is inside opaque matter: voxel {}, {}, {} has "
               "the value {}; move the eye (--eye) or raise the iso-value (--iso)\n",
               camera.eye.x, camera.eye.y, camera.eye.z, voxel.x, voxel.y, voxel.z,
               value_text(volume, value_at(volume, voxel)));
}

}  // namespace

void make_picture(PictureRequest request) {
    check(request);
    const edgesplat::OutputChoice& output = request.document.output;
    edgesplat::Settings settings = request.document.quality.settings;
    const auto volume = std::make_shared<const edgesplat::Volume>(load(request));
    if (output.renderer != edgesplat::RendererKind::Splat)
        require_samples(*volume, fmt::format("--renderer {}", name_of(output.renderer)));
    if (request.document.quality.max_error) require_samples(*volume, "--max-error");
    const edgesplat::Scene scene = resolve_scene(request.document, *volume);
    const edgesplat::Camera camera = resolve_camera(request.document, *volume, scene);
    if (!request.quiet && eye_in_opaque(*volume, scene, camera)) warn_about_eye(*volume, camera);

    const edgesplat::FrameRequest planned{volume,   scene,       camera,
                                          settings, output.size, edgesplat::aov_request(output.aovs)};
    if (output.file.empty()) {
        fmt::print("{}", edgesplat::to_text(edgesplat::describe_frame(planned, request.device.profile)));
        return;
    }
    RunDescription description{request.command_line,
                               volume.get(),
                               &scene,
                               camera,
                               recorded_path(request, request.document.volume.path),
                               {},
                               {},
                               {}};
    std::vector<RenderedFrame> frames;
    std::vector<CpuMeasurements> measurements;
    std::optional<edgesplat::accuracy::ChosenSettings> choice;
    std::uint64_t validation_messages = 0;
    if (on_processor(output.renderer)) {
        CpuFrames done = render_on_processor({output, settings, request.quiet}, *volume, scene, camera);
        frames = std::move(done.frames);
        measurements = std::move(done.measurements);
        description.device = "the processor";
        if (scene.effects.overlays.any())
            for (RenderedFrame& frame : frames)
                edgesplat::draw_overlays(frame.result.color, *volume, scene, camera);
    } else {
        edgesplat::Renderer renderer(request.device);
        renderer.set_memory_budget(request.explain.budget_bytes());
        renderer.set_volume(volume);
        const auto& max_error = request.document.quality.max_error;
        choice = apply_max_error(max_error, renderer, *volume, scene, camera, output.size, settings, request.quiet);
        frames = render_frames(output, settings, renderer, scene, camera, request.quiet);
        if (request.explain.explain) {
            const auto plan = edgesplat::describe_frame(planned, renderer, &frames.back().result.stats);
            fmt::print("{}\n", edgesplat::to_text(plan));
            description.plan = to_json(plan);
        }
        const edgesplat::DeviceInfo& device = renderer.device();
        description.device = fmt::format("{}, {} {}", device.name, device.driver, device.driver_version);
        validation_messages = renderer.validation_messages();
    }
    description.scene_text = scene_of_picture(request, *volume, scene, camera, settings);

    edgesplat::ImageMetadata metadata = picture_metadata(description);
    metadata.emplace_back("edgesplat:renderer", name_of(output.renderer));
    nlohmann::ordered_json json = statistics(description, frames);
    add_error_estimate(choice, request.document.quality.max_error, metadata, json);
    std::vector<edgesplat::FileContent> files = picture_files(output.file, frames, metadata);
    if (!request.json.empty()) {
        add_renderer_statistics(json, output, measurements);
        files.push_back({request.json, edgesplat::json_text(json, 2) + "\n"});
    }
    edgesplat::write_files(files);

    const edgesplat::RenderStats& stats = frames.back().result.stats;
    if (!request.quiet && !measurements.empty())
        fmt::print("{}: {}, error at most about {:.1g}, {:.1f} s\n", output.file, name_of(output.renderer),
                   measurements.back().error_estimate, measurements.back().seconds);
    else if (!request.quiet && output.renderer == edgesplat::RendererKind::Raycast)
        fmt::print("{}: {}, {:.1f} ms on {}\n", output.file, name_of(output.renderer), stats.frame_milliseconds,
                   stats.device.name);
    else if (!request.quiet)
        fmt::print("{}: {} splats in {} sheets, {:.1f} ms on {}\n", output.file, stats.splats_drawn, stats.sheets,
                   stats.frame_milliseconds, stats.device.name);
    if (stats.level > stats.wanted_level) {
        fmt::print(stderr,
                   "edgesplat: warning: {}: drawn at level {}, with voxels {} times as wide: the splats of level {} do "
                   "not fit into memory\n",
                   volume->name, stats.level, 1 << stats.level, stats.level - 1);
    }
    if (validation_messages > 0)
        edgesplat::fail("the picture is written, but Vulkan validation reported {} messages", validation_messages);
}

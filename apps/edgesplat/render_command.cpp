#include "apps/edgesplat/render_command.h"

#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <memory>

#include "apps/edgesplat/camera_options.h"
#include "apps/edgesplat/cpu_renderers.h"
#include "apps/edgesplat/max_error_option.h"
#include "apps/edgesplat/render_output.h"
#include "apps/edgesplat/scene_options.h"
#include "apps/edgesplat/volume_options.h"
#include "engine/error.h"

namespace {

constexpr std::array<std::string_view, 2> kPictureExtensions{".png", ".exr"};
constexpr std::array<std::string_view, 1> kJsonExtensions{".json"};
constexpr std::array<const char*, 4> kAovNames{"tau", "depth", "normal", "distance"};

/// Everything the command line said.
struct RenderOptions {
    std::string volume_path;
    VolumeOptions volume;
    SceneOptions scene;
    CameraOptions camera;
    edgesplat::Settings settings;
    MaxErrorOption max_error;
    RendererOptions renderer;
    std::string output, json;
    std::vector<std::string> aovs;
    std::string compare;
    edgesplat::DeviceChoice device;
    bool quiet = false;
};

bool wants(const RenderOptions& options, const char* aov) {
    return std::find(options.aovs.begin(), options.aovs.end(), aov) != options.aovs.end();
}

/// Refuses what cannot be written before anything is computed.
void check_outputs(const RenderOptions& options) {
    edgesplat::check_output_path(options.output, kPictureExtensions);
    if (!options.json.empty()) edgesplat::check_output_path(options.json, kJsonExtensions);
    if (edgesplat::is_png_path(options.output))
        for (const std::string& aov : options.aovs)
            edgesplat::check_output_path(aov_path(options.output, aov));
}

edgesplat::Volume load(const RenderOptions& options) {
    edgesplat::Volume volume = load_from_options(options.volume_path, options.volume, options.quiet);
    if (volume.non_finite_count > 0 && !options.quiet)
        fmt::print(stderr, "edgesplat: warning: {}: {} samples are not finite and taken as {}\n", volume.name,
                   volume.non_finite_count, volume.min_value);
    preprocess(options.scene, volume);
    return volume;
}

/// The frames asked for: with --compare the plain one first.
std::vector<RenderedFrame> render_frames(const RenderOptions& options, edgesplat::Renderer& renderer,
                                         const edgesplat::Scene& scene, const edgesplat::Camera& camera) {
    std::vector<RenderedFrame> frames;
    if (!options.compare.empty()) {
        edgesplat::Settings plain = options.settings;
        plain.edges = edgesplat::EdgeEstimator::Off;
        frames.push_back({"plain", plain, {}});
    }
    const bool edges = options.settings.edges != edgesplat::EdgeEstimator::Off;
    frames.push_back({edges ? "edges" : "plain", options.settings, {}});
    const edgesplat::AovRequest aovs{wants(options, "tau"), wants(options, "depth"), wants(options, "normal"),
                                     wants(options, "distance")};
    const glm::ivec2& size = options.camera.size;
    for (RenderedFrame& frame : frames)
        frame.result =
            casts_rays(options.renderer.kind)
                ? renderer.raycast(scene, camera, frame.settings, raycast_settings(options.renderer), size.x, size.y)
                : renderer.render(scene, camera, frame.settings, size.x, size.y, aovs);
    return frames;
}

/// Everything the command leaves; `measurements` of the renderers that have them.
void write(const RenderOptions& options, const RunDescription& description, const std::vector<RenderedFrame>& frames,
           const std::vector<CpuMeasurements>& measurements,
           const std::optional<edgesplat::accuracy::ChosenSettings>& choice = {}) {
    edgesplat::ImageMetadata metadata = picture_metadata(description);
    metadata.emplace_back("edgesplat:renderer", name_of(options.renderer.kind));
    nlohmann::ordered_json json = statistics(description, frames);
    add_error_estimate(choice, options.max_error, metadata, json);
    std::vector<edgesplat::FileContent> files = picture_files(options.output, frames, metadata);
    if (!options.json.empty()) {
        add_renderer_statistics(json, options.renderer, measurements);
        files.push_back({options.json, json.dump(2) + "\n"});
    }
    edgesplat::write_files(files);
}

void run(RenderOptions options, const std::string& command_line) {
    check_outputs(options);
    if (casts_rays(options.renderer.kind) && !options.aovs.empty())
        edgesplat::fail("--renderer {} has no extra outputs", name_of(options.renderer.kind));
    check_cpu_request(options.renderer, options.volume_path, options.scene, options.aovs, !options.compare.empty());
    edgesplat::validate(options.settings);
    const auto volume = std::make_shared<const edgesplat::Volume>(load(options));
    const edgesplat::Scene scene = scene_from_options(options.scene, *volume);
    const edgesplat::Camera camera = camera_from_options(options.camera, *volume, scene);

    const RunDescription description{command_line, volume.get(), &scene, camera};
    if (options.max_error.rms && options.renderer.kind != RendererKind::Splat)
        edgesplat::fail("--max-error chooses how to splat; it needs --renderer splat");
    if (on_processor(options.renderer.kind)) {
        const CpuRequest request{options.renderer,         options.settings,      options.camera.size,
                                 !options.compare.empty(), wants(options, "tau"), options.quiet};
        const CpuFrames done = render_on_processor(request, *volume, scene, camera);
        write(options, description, done.frames, done.measurements);
        const CpuMeasurements& last = done.measurements.back();
        if (!options.quiet)
            fmt::print("{}: {}, error at most about {:.1g}, {:.1f} s\n", options.output, name_of(options.renderer.kind),
                       last.error_estimate, last.seconds);
        return;
    }
    edgesplat::Renderer renderer(options.device);
    renderer.set_volume(volume);
    const auto choice = apply_max_error(options.max_error, renderer, *volume, scene, camera, options.camera.size,
                                        options.settings, options.quiet);
    const std::vector<RenderedFrame> frames = render_frames(options, renderer, scene, camera);
    write(options, description, frames, {}, choice);

    const edgesplat::RenderStats& stats = frames.back().result.stats;
    if (!options.quiet && casts_rays(options.renderer.kind))
        fmt::print("{}: {}, {:.1f} ms on {}\n", options.output, name_of(options.renderer.kind),
                   stats.frame_milliseconds, stats.device.name);
    else if (!options.quiet)
        fmt::print("{}: {} splats in {} sheets, {:.1f} ms on {}\n", options.output, stats.splats_drawn, stats.sheets,
                   stats.frame_milliseconds, stats.device.name);
    if (renderer.validation_messages() > 0)
        edgesplat::fail("the picture is written, but Vulkan validation had {} messages",
                        renderer.validation_messages());
}

void add_output_options(CLI::App& command, RenderOptions& options) {
    constexpr const char* kGroup = "Output";
    command
        .add_option("-o,--output", options.output,
                    "The picture: .png (8 bit sRGB) or .exr (float32 linear, with alpha)")
        ->required()
        ->type_name("FILE")
        ->group(kGroup);
    CLI::Option* aov =
        command
            .add_option(
                "--aov", options.aovs,
                "Extra outputs, with commas between: channels of an .exr picture, or FILE.tau.exr, ... beside a .png")
            ->type_name("tau,depth,normal,distance")
            ->delimiter(',')
            ->allow_extra_args(false)
            ->check(CLI::IsMember(std::vector<std::string>(kAovNames.begin(), kAovNames.end())).description(""))
            ->group(kGroup);
    command
        .add_option("--compare", options.compare,
                    "Side by side: conventional splatting left, this command's picture right")
        ->type_name("plain")
        ->check(CLI::IsMember(std::vector<std::string>{"plain"}).description(""))
        ->excludes(aov)
        ->group(kGroup);
    command
        .add_option("--json", options.json,
                    "Statistics: milliseconds per pass, counts, memory, device, driver, version")
        ->type_name("FILE")
        ->group(kGroup);
    command.add_flag("-q,--quiet", options.quiet, "Say nothing unless something is wrong")->group(kGroup);
}

void add_device_options(CLI::App& command, RenderOptions& options) {
    constexpr const char* kGroup = "Device";
    command
        .add_option("--device", options.device.device,
                    "A Vulkan device: its number in --list-devices, or a part of its name")
        ->type_name("DEVICE")
        ->group(kGroup);
    command
        .add_flag_callback(
            "--list-devices",
            [] {
                print_devices();
                throw CLI::Success();
            },
            "Print the Vulkan devices and leave")
        ->group(kGroup);
    command
        .add_flag("--validation", options.device.validation,
                  "Check every Vulkan call; any message makes the command fail")
        ->group(kGroup);
}

}  // namespace

void print_devices() {
    const std::vector<edgesplat::DeviceInfo> devices = edgesplat::list_devices();
    if (devices.empty())
        fmt::print("no Vulkan device; the package mesa-vulkan-drivers brings one that runs on the processor\n");
    for (const edgesplat::DeviceInfo& d : devices) {
        fmt::print("{}: {} ({}), {} {}, Vulkan {}\n", d.index, d.name, d.type, d.driver, d.driver_version,
                   d.api_version);
        for (const std::string& reason : d.rejections)
            fmt::print("   cannot be used: {}\n", reason);
    }
}

void add_render_command(CLI::App& app, const std::string& command_line) {
    CLI::App& command = *app.add_subcommand("render", "Render a volume to a picture");
    const auto options = std::make_shared<RenderOptions>();
    command
        .add_option("VOLUME", options->volume_path,
                    "A volume file, a folder or pattern of slices, or builtin:NAME (see `edgesplat info --help`)")
        ->required()
        ->type_name("");
    add_output_options(command, *options);
    add_camera_options(command, options->camera);
    add_scene_options(command, options->scene);
    add_renderer_options(command, options->renderer);
    add_max_error_option(command, options->max_error);
    add_settings_options(command, options->settings);
    add_volume_options(command, options->volume);
    add_device_options(command, *options);
    command.footer(
        "Examples:\n"
        "  edgesplat render builtin:sphere -o sphere.png --compare plain\n"
        "  edgesplat render head.nrrd --iso -400 -o head.png --view close --size 800x600\n"
        "  edgesplat render head.nrrd --iso -400 -o nose.png --voxel --eye 128,148,14 --direction 0,1,0.05 --fov 90\n"
        "  edgesplat render head.nrrd --iso=-400,300 --color 1,.8,.7 --color 1,1,.9 --extinction .1 --extinction 8 -o "
        "two.exr --aov depth,normal");
    command.callback([options, command_line] { run(*options, command_line); });
}

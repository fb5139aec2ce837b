#include "apps/edgesplat/accuracy_command.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <vector>

#include "apps/edgesplat/option_values.h"
#include "apps/edgesplat/progress_bar.h"
#include "apps/edgesplat/scene_options.h"
#include "apps/edgesplat/volume_options.h"
#include "engine/accuracy/analytic_truth.h"
#include "engine/accuracy/downsample.h"
#include "engine/accuracy/measure.h"
#include "engine/accuracy/report_files.h"
#include "engine/accuracy/report_text.h"
#include "engine/error.h"
#include "engine/volume/packed_volume.h"

namespace {

using edgesplat::accuracy::ReportInput;
using edgesplat::accuracy::ReportOptions;

constexpr int kFullOrbit = 360;
constexpr int kQuickSize = 96;                    ///< pixels, width and height
constexpr std::size_t kMostQuickVoxels = 500000;  ///< that --quick measures in about a minute on two cores

/// Values of the command line.
struct AccuracyCommand {
    std::string volume_path;
    VolumeOptions volume;
    DocumentEdits edits;
    std::string folder;
    ReportOptions report;
    double orbit = 36, repeats = 5;
    bool full = false, quick = false, quiet = false;
    std::vector<int> downsample;
    std::optional<std::array<glm::ivec3, 2>> crop;
    edgesplat::DeviceChoice device;
};

/// The scene that the options describe, without a scene file.
edgesplat::SceneDocument document_of(const AccuracyCommand& command) {
    edgesplat::SceneDocument document;
    document.volume.path = command.volume_path;
    apply(command.volume, document.volume);
    command.edits.apply(document);
    if (command.crop) {
        document.volume.crop_low = (*command.crop)[0];
        document.volume.crop_high = (*command.crop)[1];
    }
    return document;
}

ReportInput input_of(edgesplat::SceneDocument document, bool quiet, const std::string& command_line) {
    ReportInput input;
    input.volume =
        std::make_shared<const edgesplat::Volume>(load_with_progress(document, edgesplat::volume_folders({}), quiet));
    require_samples(*input.volume, "accuracy");
    input.scene = resolve_scene(document, *input.volume);
    input.analytic = edgesplat::accuracy::analytic_scene_of(document.volume);
    input.program = "edgesplat " EDGESPLAT_VERSION;
    input.command = command_line;
    return input;
}

/// Replaces the defaults of the options that are not given.
void use_quick(const CLI::App& app, AccuracyCommand& command) {
    if (app.count("--size") == 0) command.report.size = glm::ivec2(kQuickSize);
    if (app.count("--repeats") == 0) command.repeats = 1;
    if (app.count("--orbit") == 0) command.orbit = 0;
    if (app.count("--knobs") == 0) command.report.knobs = {"edges"};
    if (app.count("--cameras") == 0) command.report.cameras = {"far"};
}

/// Throws Error for a volume that --quick cannot measure in a minute, naming a part of it.
void check_quick(const edgesplat::Volume& volume) {
    const glm::ivec3 dims = volume.geometry.dims;
    const auto voxels = volume.geometry.voxel_count();
    if (voxels <= kMostQuickVoxels) return;
    const glm::dvec3 all(dims);
    const glm::ivec3 part(all * std::cbrt(static_cast<double>(kMostQuickVoxels) / static_cast<double>(voxels)));
    const glm::ivec3 low = (dims - part) / 2, high = low + part - 1;
    edgesplat::fail(
        "{}: {} x {} x {} voxels: --quick measures at most {}; leave --quick out, or measure the middle with --crop "
        "{},{},{},{},{},{}",
        volume.name, dims.x, dims.y, dims.z, kMostQuickVoxels, low.x, low.y, low.z, high.x, high.y, high.z);
}

/// Six comma-separated integers: the first and the last voxel. nullopt for any other text.
std::optional<std::array<glm::ivec3, 2>> parse_box(const std::string& text) {
    std::array<int, 6> values{};
    const char* at = text.data();
    const char* const end = at + text.size();
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (i > 0 && (at == end || *at++ != ',')) return {};
        const auto [next, error] = std::from_chars(at, end, values[i]);
        if (error != std::errc()) return {};
        at = next;
    }
    if (at != end) return {};
    return std::array{glm::ivec3(values[0], values[1], values[2]), glm::ivec3(values[3], values[4], values[5])};
}

/// Throws Interrupted on Ctrl-C.
void run_resolution(const AccuracyCommand& command, const ReportInput& input, const ReportOptions& options) {
    const edgesplat::accuracy::ResolutionRequest request{.volume = input.volume,
                                                         .scene = input.scene,
                                                         .factors = command.downsample,
                                                         .size = options.size,
                                                         .settings = options.base,
                                                         .program = input.program,
                                                         .command = input.command};
    edgesplat::Renderer renderer(command.device);
    const StopRequest stop("stopped; nothing was written");
    edgesplat::accuracy::ResolutionReport report;
    {
        ProgressBar bar(command.quiet);
        report = measure_resolution(renderer, request, [&](const edgesplat::accuracy::Progress& p) {
            bar.update(p.done, p.seconds_left, p.what);
            return !stop.asked();
        });
    }
    write_resolution(report, options.folder);
    if (!command.quiet) fmt::print("{}{}\n", resolution_table(report), (options.folder / "resolution.html").string());
}

/// Throws Interrupted on Ctrl-C.
void run(const AccuracyCommand& command, const std::string& command_line) {
    ReportOptions options = command.report;
    options.folder = command.folder;
    options.repeats = static_cast<int>(command.repeats);
    options.orbit_frames = command.full ? kFullOrbit : static_cast<int>(command.orbit);
    const edgesplat::SceneDocument document = document_of(command);
    options.base = document.quality.settings;
    edgesplat::validate(options.base);
    edgesplat::accuracy::check_report_folder(options.folder);
    const ReportInput input = input_of(document, command.quiet, command_line);
    if (command.quick) check_quick(*input.volume);
    if (!command.downsample.empty()) return run_resolution(command, input, options);

    edgesplat::Renderer renderer(command.device);
    renderer.set_volume(input.volume);
    const StopRequest stop("stopped; run the same command again to continue from the saved measurements");
    edgesplat::accuracy::Measured measured;
    {
        ProgressBar bar(command.quiet);
        bool announced = command.quiet;
        measured = measure_accuracy(renderer, input, options, [&](const edgesplat::accuracy::Progress& p) {
            if (!announced)
                fmt::print("{} measurements, about {}\n", p.pieces - p.pieces_done, duration_text(p.seconds_left));
            if (!announced) std::fflush(stdout);
            announced = true;
            bar.update(p.done, p.seconds_left, p.what);
            return !stop.asked();
        });
    }
    edgesplat::accuracy::write_report(measured);
    if (command.quiet) return;
    fmt::print("{}", edgesplat::accuracy::steps_table(measured.report));
    for (const std::string& note : measured.report.notes)
        fmt::print("{}\n", note);
    fmt::print("{}\n", (options.folder / "index.html").string());
}

void add_report_options(CLI::App& app, AccuracyCommand& command) {
    constexpr const char* kGroup = "Report";
    app.add_option("--report", command.folder,
                   "Folder for index.html, report.json, steps.csv and the data needed to continue after Ctrl-C")
        ->required()
        ->type_name("DIR")
        ->group(kGroup);
    app.add_option_function<std::string>(
           "--size",
           [&command](const std::string& text) {
               const auto size = parse_size(text);
               if (!size) throw CLI::ValidationError("--size", fmt::format("'{}' is not WxH, such as 192x192", text));
               command.report.size = *size;
           },
           "Size of the measured pictures, pixels")
        ->type_name("WxH")
        ->default_str("192x192")
        ->group(kGroup);
    add_number(app, "--tolerance", command.report.tolerance, {1e-7, 0.01},
               "Largest error of a pixel of the reference pictures; full scale is 1")
        ->group(kGroup);
    add_number(app, "--repeats", command.repeats, {1, 1000}, "Number of timing rounds")->group(kGroup);
    add_number(app, "--orbit", command.orbit, {0, 3600},
               "Number of frame pairs, one degree apart, that measure popping; 0: none")
        ->group(kGroup);
    CLI::Option* full =
        app.add_flag("--full", command.full, "Measure popping over a full turn of 360 frames")->group(kGroup);
    app.add_flag("--quick", command.quick,
                 fmt::format("Measure a volume of at most {} voxels in about a minute on two cores: as --size {}x{} "
                             "--repeats 1 --orbit 0 --knobs edges --cameras far, unless these are given",
                             kMostQuickVoxels, kQuickSize, kQuickSize))
        ->excludes(full)
        ->group(kGroup);
    const auto add_names = [&](const char* option, std::vector<std::string>& names, const char* type,
                               const char* help) {
        app.add_option(option, names, help)->type_name(type)->delimiter(',')->allow_extra_args(false)->group(kGroup);
    };
    add_names("--knobs", command.report.knobs, "NAME,...", "Measure only these settings, and no combinations");
    add_names("--cameras", command.report.cameras, "far,near,grazing,inside", "Measure only these cameras");
    app.add_flag("--restart", command.report.restart, "Delete the results of an earlier run in the folder")
        ->group(kGroup);
    app.add_option("--downsample", command.downsample,
                   "Measure something else: the detail lost by copies of the volume that are coarser by these factors, "
                   "and the part that edge preservation recovers")
        ->type_name("2,4")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->check(CLI::Range(2, 64).description(""))
        ->group(kGroup);
    app.add_option_function<std::string>(
           "--crop",
           [&command](const std::string& text) {
               command.crop = parse_box(text);
               if (!command.crop)
                   throw CLI::ValidationError(
                       "--crop", fmt::format("'{}' is not X,Y,Z,X,Y,Z, the first and the last voxel", text));
           },
           "Use only this part of the volume: first and last voxel, both included")
        ->type_name("X,Y,Z,X,Y,Z")
        ->group(kGroup);
    app.add_flag("-q,--quiet", command.quiet, "Print only warnings and errors")->group(kGroup);
    app.add_option("--device", command.device.device,
                   "Vulkan device: its number in --list-devices or a part of its name")
        ->type_name("DEVICE")
        ->group("Device");
}

}  // namespace

void add_accuracy_command(CLI::App& app, const std::string& command_line, int& exit_status) {
    CLI::App& sub = *app.add_subcommand("accuracy", "Measure error and time of each accuracy setting");
    const auto command = std::make_shared<AccuracyCommand>();
    sub.add_option("VOLUME", command->volume_path, "A volume, or builtin:NAME, whose exact picture is known")
        ->required()
        ->type_name("");
    add_report_options(sub, *command);
    add_scene_options(sub, command->edits);
    add_settings_options(sub, command->edits);
    add_volume_options(sub, command->volume);
    sub.footer(
        "Examples:\n"
        "  edgesplat accuracy builtin:sphere --report sphere --quick\n"
        "  edgesplat accuracy head.nrrd --iso -400 --report head --size 128x128\n"
        "  edgesplat accuracy head.nrrd --iso -400 --report coarse --downsample 2,4");
    sub.callback([command, command_line, &exit_status, &sub] {
        if (command->quick) use_quick(sub, *command);
        run_until_stopped(exit_status, [&] { run(*command, command_line); });
    });
}

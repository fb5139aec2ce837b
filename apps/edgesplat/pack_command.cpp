#include "apps/edgesplat/pack_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <memory>
#include <string>
#include <string_view>

#include "apps/edgesplat/progress_bar.h"
#include "apps/edgesplat/volume_options.h"
#include "engine/accuracy/work_list.h"
#include "engine/image/image_file.h"
#include "engine/volume/pack_volume.h"

namespace {

constexpr std::array<std::string_view, 1> kExtensions{".esv"};

struct PackCommand {
    std::string path, output;
    VolumeOptions volume;
    edgesplat::PackOptions pack;
    bool quiet = false;
};

edgesplat::LoadOptions load_options(const VolumeOptions& options) {
    edgesplat::VolumeSource source;
    apply(options, source);
    edgesplat::LoadOptions load;
    load.component = source.component;
    load.frame = source.frame;
    load.level = source.level;
    load.series = source.series;
    load.raw = source.raw;
    load.spacing = source.spacing;
    load.resample = source.resample;
    load.no_data = source.no_data;
    return load;
}

/// Throws Interrupted on Ctrl-C.
void run(const PackCommand& command) {
    using Clock = std::chrono::steady_clock;
    edgesplat::check_output_path(command.output, kExtensions);
    const std::string path = edgesplat::find_volume(command.path, edgesplat::volume_folders({}));
    const StopRequest stop;
    const auto begin = Clock::now();
    const auto seconds = [&] { return std::chrono::duration<double>(Clock::now() - begin).count(); };
    edgesplat::PackSummary summary;
    {
        ProgressBar bar(command.quiet);
        edgesplat::LoadOptions load = load_options(command.volume);
        load.progress = [&](double fraction, std::string_view what) {
            if (stop.asked()) throw edgesplat::accuracy::Interrupted("stopped; nothing was written");
            bar.update(fraction, seconds() * (1 - fraction) / std::max(fraction, 0.01), std::string(what));
        };
        edgesplat::PackOptions options = command.pack;
        options.progress = [&](double fraction, std::string_view what) {
            bar.update(fraction, seconds() * (1 - fraction) / std::max(fraction, 0.01), std::string(what));
            if (stop.asked()) throw edgesplat::accuracy::Interrupted("stopped; nothing was written");
            return true;
        };
        summary = pack_file(path, load, command.output, options);
    }
    if (command.quiet) return;
    const glm::ivec3& dims = summary.geometry.dims;
    fmt::print("{}: {} x {} x {} voxels as {}, {} level{}, {:.1f} MB, {:.1f} s\n", command.output, dims.x, dims.y,
               dims.z, summary.sample_type, summary.levels, summary.levels == 1 ? "" : "s",
               static_cast<double>(summary.bytes) / 1e6, seconds());
    if (summary.quantisation_error > 0)
        fmt::print("quantised: the largest error of a sample is {:.3g}\n", summary.quantisation_error);
}

}  // namespace

void add_pack_command(CLI::App& app, int& exit_status) {
    const auto command = std::make_shared<PackCommand>();
    CLI::App& sub = *app.add_subcommand(
        "pack", "Pack a volume into bricks at several resolutions, for rendering without loading all of it");
    sub.add_option("VOLUME", command->path, "A volume file, a folder or pattern of slices, or builtin:NAME:SIZE")
        ->required()
        ->type_name("");
    sub.add_option("-o,--output", command->output, "The packed volume, .esv")->required()->type_name("FILE");
    sub.add_flag("--compress", command->pack.compress,
                 "Compress the bricks (deflate): a smaller file, slower to write and read");
    sub.add_option("--quantise", command->pack.quantise,
                   "Quantise samples to equally spaced values of this many bits, unless they are integers of that "
                   "size. The largest error is printed. Default: every sample is kept exactly, in the smallest of "
                   "uint8, int16, uint16 and float32")
        ->check(CLI::IsMember({8, 16}))
        ->type_name("BITS");
    sub.add_flag("-q,--quiet", command->quiet, "Print only warnings and errors");
    add_volume_options(sub, command->volume);
    sub.footer(
        "builtin:NAME, raw files and uncompressed NRRD and MetaImage files are read piece by piece, with at most\n"
        "about 100 MB in memory. All other files must fit into memory.\n"
        "Examples:\n"
        "  edgesplat pack head.nrrd -o head.esv\n"
        "  edgesplat pack scan.raw --raw 2048x2048x3000:uint16:little:0.05,0.05,0.05 -o scan.esv --compress\n"
        "  edgesplat pack builtin:sphere:1024 -o sphere.esv --quantise 16\n"
        "  edgesplat info head.esv");
    sub.callback([command, &exit_status] { run_until_stopped(exit_status, [&] { run(*command); }); });
}

#include "apps/edgesplat/bench_command.h"

#include <fmt/format.h>

#include <cstdio>
#include <memory>

#include "apps/edgesplat/camera_options.h"
#include "apps/edgesplat/option_values.h"
#include "apps/edgesplat/progress_bar.h"
#include "apps/edgesplat/scene_options.h"
#include "apps/edgesplat/volume_options.h"
#include "engine/bench/compare.h"
#include "engine/bench/run.h"
#include "engine/bench/run_output.h"
#include "engine/bench/suite.h"
#include "engine/volume/packed_volume.h"

namespace {

/// Values of the command line.
struct BenchCommand {
    std::string suite = "standard", folder, earlier, later, cases;
    VolumeOptions volume;
    DocumentEdits edits;
    edgesplat::bench::BenchOptions options;
    std::optional<double> rounds;
    bool list = false, quiet = false;
};

void print_cases(const edgesplat::bench::Suite& suite) {
    for (const auto& entry : suite.cases)
        fmt::print("{}\n", entry.name);
    for (const auto& entry : suite.skipped)
        fmt::print("{} (skipped: {})\n", entry.name, entry.reason);
}

void print_comparison(const nlohmann::ordered_json& earlier, const nlohmann::ordered_json& later) {
    fmt::print("{}", comparison_table(edgesplat::bench::compare_runs(earlier, later)));
}

/// The scene that the options describe.
edgesplat::SceneDocument document_of(const BenchCommand& command) {
    edgesplat::SceneDocument document;
    apply(command.volume, document.volume);
    command.edits.apply(document);
    return document;
}

/// The suite that is named, or that of the volume that is named.
edgesplat::bench::Suite suite_of(const BenchCommand& command) {
    edgesplat::SceneDocument document = document_of(command);
    if (const auto suite = edgesplat::bench::find_suite(command.suite)) {
        if (document != edgesplat::SceneDocument{})
            edgesplat::fail("options of a scene or volume are for `bench VOLUME`; {} is a suite", command.suite);
        return *suite;
    }
    document.volume.path = command.suite;
    const auto volume = std::make_shared<const edgesplat::Volume>(
        load_with_progress(document, edgesplat::volume_folders({}), command.quiet));
    require_samples(*volume, "bench");
    return edgesplat::bench::volume_suite(document, volume);
}

/// Throws Interrupted on Ctrl-C.
void run(const BenchCommand& command, const std::string& command_line) {
    namespace bench = edgesplat::bench;
    const auto earlier = command.earlier.empty() ? nlohmann::ordered_json() : bench::read_run(command.earlier);
    if (!command.later.empty()) return print_comparison(earlier, bench::read_run(command.later));
    bench::Suite suite = suite_of(command);
    const bool of_volume = !suite.loaded.empty();
    if (!command.cases.empty()) bench::keep_cases(suite, command.cases);
    if (command.list) return print_cases(suite);
    if (!command.folder.empty()) bench::check_run_folder(command.folder);
    bench::BenchOptions options = command.options;
    if (command.rounds) options.rounds = static_cast<int>(*command.rounds);
    if (of_volume && !command.quiet && !options.rounds) {
        fmt::print("{}: {} pictures, about {}\n", suite.about, suite.cases.size(),
                   duration_text(options.budget.value_or(suite.budget)));
        std::fflush(stdout);
    }
    bench::BenchRun result;
    {
        const StopRequest stop("stopped; nothing was written");
        ProgressBar bar(command.quiet);
        result = bench::run_suite(suite, options, [&](const edgesplat::accuracy::Progress& p) {
            bar.update(p.done, p.seconds_left, p.what);
            return !stop.asked();
        });
    }
    result.program = "edgesplat " EDGESPLAT_VERSION;
    result.command = command_line;
    if (!command.quiet) fmt::print("{}", of_volume ? volume_table(result, suite) : run_tables(result));
    if (!command.folder.empty()) {
        const std::string note = write_run(result, command.folder);
        if (!note.empty()) fmt::print(stderr, "edgesplat: {}\n", note);
    }
    if (!earlier.is_null()) print_comparison(earlier, run_json(result));
}

}  // namespace

void add_bench_command(CLI::App& app, const std::string& command_line, int& exit_status) {
    CLI::App& sub =
        *app.add_subcommand("bench", "Measure frame time, setup time, work and memory, compared with the ray caster");
    const auto command = std::make_shared<BenchCommand>();
    sub.add_option(
           "SUITE", command->suite,
           "A suite: standard, scaling, full, or a file (.toml, docs/benchmarks.md); or a volume, measured from "
           "far, near and inside in about a minute")
        ->type_name("")
        ->default_str("standard");
    sub.add_option("-o,--output", command->folder, "Folder for bench.json, bench.csv and plots (SVG)")
        ->type_name("DIR");
    CLI::Option* compare = sub.add_option("--compare", command->earlier,
                                          "Print the ratio of every figure to that of an earlier bench.json")
                               ->type_name("EARLIER.json");
    sub.add_option("--with", command->later, "Compare this bench.json instead of measuring")
        ->type_name("LATER.json")
        ->needs(compare);
    sub.add_flag("--list", command->list, "Print the suite's cases and exit");
    sub.add_option("--cases", command->cases,
                   "Run only cases whose name matches, such as 'sphere-*' or '*/plain/512x512'")
        ->type_name("GLOB");
    CLI::Option* repeat = add_number(sub, "--repeat", command->rounds, {1, 1000}, "Number of rounds");
    add_number(sub, "--budget", command->options.budget, {0, 1e6, true},
               "Time for all rounds; no round starts that would exceed it. Default: the suite's")
        ->type_name("SECONDS")
        ->excludes(repeat);
    sub.add_option("--device", command->options.device.device,
                   "Vulkan device: its number in --list-devices or a part of its name")
        ->type_name("DEVICE");
    sub.add_flag("-q,--quiet", command->quiet, "Print no progress and no tables");
    add_size_option(sub, command->edits)->group("Scene");
    add_scene_options(sub, command->edits);
    add_volume_options(sub, command->volume);
    sub.footer(
        "Volumes are searched in the folders of EDGESPLAT_VOLUMES. A case without its volume is skipped.\n"
        "Examples:\n"
        "  edgesplat bench head.nrrd --iso -400\n"
        "  edgesplat bench -o before\n"
        "  edgesplat bench -o after --compare before/bench.json\n"
        "  edgesplat bench scaling --cases '*/default/*' --repeat 3");
    sub.callback([command, command_line, &exit_status] {
        run_until_stopped(exit_status, [&] { run(*command, command_line); });
    });
}

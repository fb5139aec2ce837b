#include "apps/edgesplat/footprints_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "apps/plots/paper_curves.h"
#include "footprints/footprint_cache.h"
#include "footprints/footprint_integral.h"
#include "footprints/footprint_table.h"
#include "footprints/kernel.h"

namespace {

using namespace edgesplat;

struct Options {
    EdgeBand band;
    std::string plot_folder;
    bool report = false;
    int samples = 20000;
};

template <typename Function>
double milliseconds(const Function& f) {
    const auto start = std::chrono::steady_clock::now();
    f();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

// Largest and 99th percentile error of a mode, percent of the plain footprint's peak.
template <typename Mode>
void print_accuracy(const char* name, const std::vector<std::pair<double, Ray>>& samples,
                    const std::vector<double>& truth, const Mode& mode) {
    std::vector<double> errors;
    for (std::size_t i = 0; i < samples.size(); ++i)
        errors.push_back(100 * std::abs(mode(samples[i].second, samples[i].first) - truth[i]) / kernel_footprint(0));
    std::sort(errors.begin(), errors.end());
    fmt::print("  {:<12} {:>9.3f} {:>9.3f}\n", name, errors.back(), errors[(errors.size() - 1) * 99 / 100]);
}

void report(const Options& options) {
    const EdgeBand& band = options.band;
    FootprintTable table = FootprintTable::build(band, {2, 2, 2, 2});
    const double build = milliseconds([&] { table = FootprintTable::build(band); });
    const FootprintTableSize& size = table.size();
    fmt::print("band: half width {} voxels, strength {}\n", band.half_width, band.strength);
    fmt::print("table: {} x {} texels, {} distances x {} directions, {:.1f} MB, built in {:.0f} ms\n", size.width,
               size.height, size.distances, size.directions, static_cast<double>(table.texels().size_bytes()) / 1e6,
               build);
    const LoadedFootprintTable first = load_footprint_table(band);
    if (!first.warning.empty()) fmt::print("cache: {}\n", first.warning);
    bool cached = false;
    const double load = milliseconds([&] { cached = load_footprint_table(band).from_cache; });
    if (cached) fmt::print("cache: read in {:.1f} ms from {}\n", load, footprint_cache_folder().string());
    fmt::print("support: radius up to {:.3f} voxels about the voxel (kernel {})\n", largest_support_radius(band),
               kKernelRadius);

    std::mt19937 random(1);
    const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<>(a, b)(random); };
    const double reach = kKernelRadius + band.half_width;
    std::vector<std::pair<double, Ray>> samples;
    std::vector<double> truth;
    for (int i = 0; i < options.samples; ++i) {
        const double c = i % 4 == 0 ? uniform(0, 0.15) : uniform(0, 1);  // edge-on is where footprints are sharpest
        samples.emplace_back(uniform(0, reach), ray_through(uniform(-2.2, 2.2), uniform(0, kKernelRadius), c));
        truth.push_back(exact_footprint(samples.back().second, Edge{samples.back().first, band}));
    }
    fmt::print("\nerror against the exact integral, percent of peak, {} random rays\n  {:<12} {:>9} {:>9}\n",
               options.samples, "footprints", "largest", "99 %");
    print_accuracy("isotropic", samples, truth, [](const Ray& ray, double) { return kernel_footprint(ray.rho2); });
    print_accuracy("warp2d", samples, truth, [&](const Ray& r, double d) {
        return warp2d_footprint(r, Edge{d, band});
    });
    print_accuracy("table", samples, truth, [&](const Ray& r, double d) { return table.nearest(r, d); });
    print_accuracy("table-lerp", samples, truth, [&](const Ray& r, double d) { return table.lerp(r, d); });
    print_accuracy("procedural", samples, truth, [&](const Ray& r, double d) {
        return procedural_footprint(r, Edge{d, band});
    });
}

}  // namespace

void add_footprints_command(CLI::App& app) {
    auto options = std::make_shared<Options>();
    CLI::App* command =
        app.add_subcommand("footprints", "Report how accurate the footprint modes are, or plot the warps");
    command->add_option("--edge-half-width", options->band.half_width, "Half width of the warped band, voxels")
        ->check(CLI::Range(0.01, 3.0))
        ->type_name("A")
        ->capture_default_str();
    command->add_option("--edge-strength", options->band.strength, "Slope of the warp at the edge; 1 is no warp")
        ->check(CLI::Range(1.0, 64.0))
        ->type_name("K")
        ->capture_default_str();
    command
        ->add_option("--plot", options->plot_folder,
                     "Write the paper's figures 4, 6, 7 and 8 into a folder (needs gnuplot)")
        ->type_name("FOLDER");
    command->add_flag("--report", options->report,
                      "Print accuracy, size and build time of the footprint table; the default without --plot");
    command->add_option("--samples", options->samples, "Random rays the report is measured on")
        ->check(CLI::Range(100, 10000000))
        ->type_name("N")
        ->capture_default_str();
    command->callback([options] {
        if (options->report || options->plot_folder.empty()) report(*options);
        if (options->plot_folder.empty()) return;
        for (const Plot& plot : paper_plots({.band = options->band}))
            fmt::print("{}\n", draw(plot, options->plot_folder, PlotFormat::Png).string());
    });
}

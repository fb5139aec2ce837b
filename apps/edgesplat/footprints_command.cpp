#include "apps/edgesplat/footprints_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "apps/plots/paper_curves.h"
#include "footprints/footprint_integral.h"
#include "footprints/footprint_table.h"
#include "footprints/kernel.h"
#include "footprints/plane_face.h"

namespace {

using namespace edgesplat;

struct Options {
    std::string plot_folder;
    bool report = false;
    int samples = 20000;
};

using Footprint = std::function<double(const Ray&, double distance)>;

struct Mode {
    const char* name;
    Footprint value;
};

/// Prints the largest and the 99th-percentile error of each mode, percent of the plain footprint's peak, over random
/// rays and edge distances up to `reach`.
void print_accuracy(const char* kernels, double reach, int samples, const Footprint& exact,
                    const std::vector<Mode>& modes) {
    std::mt19937 random(1);
    const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<>(a, b)(random); };
    std::vector<std::vector<double>> errors(modes.size());
    for (int i = 0; i < samples; ++i) {
        const double c = i % 4 == 0 ? uniform(0, 0.15) : uniform(0, 1);  // footprints are sharpest edge-on
        const double distance = uniform(0, reach);
        const Ray ray = ray_through(uniform(-2.2, 2.2), uniform(0, kKernelRadius), c);
        const double truth = exact(ray, distance);
        for (std::size_t m = 0; m < modes.size(); ++m)
            errors[m].push_back(100 * std::abs(modes[m].value(ray, distance) - truth) / kernel_footprint(0));
    }
    fmt::print("{}: error, percent of the plain peak, {} random rays\n  {:<12} {:>9} {:>9}\n", kernels, samples,
               "footprints", "largest", "99 %");
    for (std::size_t m = 0; m < modes.size(); ++m) {
        std::sort(errors[m].begin(), errors[m].end());
        fmt::print("  {:<12} {:>9.3f} {:>9.3f}\n", modes[m].name, errors[m].back(),
                   errors[m][(errors[m].size() - 1) * 99 / 100]);
    }
}

void report(const Options& options) {
    const Mode plain{"isotropic", [](const Ray& ray, double) { return kernel_footprint(ray.rho2); }};
    const auto face = [](int nodes) {
        return [nodes](const Ray& ray, double d) {
            return FacePath(plane_face(ray, d), plane_cut(d)).footprint(nodes).integral;
        };
    };
    const Footprint table = [](const Ray& ray, double d) {
        const double sine = std::sqrt(std::max(1 - ray.un * ray.un, 0.0)), x = sine > 0 ? ray.pn / sine : 0;
        return kept_footprint_table(FACE_DEPTH)
            .lookup(select_footprint_layer(d, ray.un, FACE_DEPTH), x, std::sqrt(std::max(ray.rho2 - x * x, 0.0)));
    };
    print_accuracy("cut at plane faces", kKernelRadius + FACE_DEPTH, options.samples, face(32),
                   {plain, {"table", table}, {"procedural", face(6)}});
    print_accuracy("warped by the paper's curve", kKernelRadius, options.samples,
                   [](const Ray& ray, double d) {
                       return exact_footprint(ray, PaperEdge{d, {}});
                   },
                   {plain,
                    {"warp2d",
                     [](const Ray& ray, double d) {
                         return warp2d_footprint(ray, PaperEdge{d, {}});
                     }},
                    {"procedural", [](const Ray& ray, double d) {
                         return procedural_footprint(ray, PaperEdge{d, {}});
                     }}});
}

}  // namespace

void add_footprints_command(CLI::App& app) {
    auto options = std::make_shared<Options>();
    CLI::App* command =
        app.add_subcommand("footprints", "Report the accuracy of the footprint modes, or plot the paper's curves");
    command
        ->add_option("--plot", options->plot_folder,
                     "Write the paper's figures 4, 6, 7 and 8 into a folder (needs gnuplot)")
        ->type_name("FOLDER");
    command->add_flag("--report", options->report,
                      "Print the accuracy of the footprint modes; this is the default without --plot");
    command->add_option("--samples", options->samples, "Number of random rays for the report")
        ->check(CLI::Range(100, 10000000))
        ->type_name("N")
        ->capture_default_str();
    command->callback([options] {
        if (options->report || options->plot_folder.empty()) report(*options);
        if (options->plot_folder.empty()) return;
        for (const Plot& plot : paper_plots({}))
            fmt::print("{}\n", draw(plot, options->plot_folder, PlotFormat::Png).string());
    });
}

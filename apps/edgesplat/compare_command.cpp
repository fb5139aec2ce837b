#include "apps/edgesplat/compare_command.h"

#include <fmt/format.h>

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "apps/edgesplat/option_values.h"
#include "engine/image/image_compare.h"
#include "engine/image/image_file.h"

namespace {

constexpr std::array<std::string_view, 2> kPictureExtensions{".png", ".exr"};

struct CompareOptions {
    std::string a, b, difference;
    double max_diff = 0, max_share = 0, gain = 1;
    std::optional<double> min_psnr;
};

int run(const CompareOptions& options) {
    if (!options.difference.empty()) edgesplat::check_output_path(options.difference, kPictureExtensions);
    const edgesplat::Image a = edgesplat::read_image(options.a).image;
    const edgesplat::Image b = edgesplat::read_image(options.b).image;
    const edgesplat::ImageDifference d = edgesplat::compare_images(a, b, options.max_diff);
    if (!options.difference.empty())
        edgesplat::write_image(options.difference, edgesplat::difference_image(a, b, options.gain));

    const bool within = options.min_psnr ? d.psnr >= *options.min_psnr : d.share <= options.max_share;
    fmt::print(
        "RMSE   {:.6g}\nmax    {:.6g} at pixel {},{} channel {}\nPSNR   {:.2f} dB\npixels {:.4g} % differ by more than "
        "{:g}\n{}\n",
        d.rmse, d.max, d.x, d.y, d.channel, d.psnr, 100 * d.share, options.max_diff, within ? "same" : "different");
    return within ? 0 : 1;
}

}  // namespace

void add_compare_command(CLI::App& app, int& exit_status) {
    CLI::App& command = *app.add_subcommand("compare", "Compare two pictures in linear light");
    const auto options = std::make_shared<CompareOptions>();
    command.add_option("A", options->a, "A picture (any format OpenImageIO reads)")->required()->type_name("");
    command.add_option("B", options->b, "A picture of the same size and channels")->required()->type_name("");
    CLI::Option* max_diff = add_number(command, "--max-diff", options->max_diff, {0},
                                       "Largest difference of a channel that counts as equal");
    CLI::Option* max_share =
        add_number(command, "--max-share", options->max_share, {0, 1}, "Share of pixels that may differ by more");
    add_number(command, "--min-psnr", options->min_psnr, {},
               "Smallest PSNR that passes, dB; replaces --max-diff and --max-share")
        ->excludes(max_diff)
        ->excludes(max_share);
    command.add_option("--diff", options->difference, "Write the absolute difference as a picture, .png or .exr")
        ->type_name("FILE");
    add_number(command, "--gain", options->gain, {0, std::numeric_limits<double>::infinity(), true},
               "Factor on the values of the --diff picture");
    command.footer(
        "Exit status: 0 within the limits (without options: equal), 1 different, 2 the comparison failed.\n"
        "Example:\n  edgesplat compare new.png golden.png --max-diff 0.02 --max-share 0.001 --diff diff.png --gain 10");
    command.callback([options, &exit_status] { exit_status = run(*options); });
}

#include "apps/edgesplat/rerun_command.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <filesystem>
#include <memory>

#include "apps/edgesplat/picture.h"
#include "engine/error.h"
#include "engine/image/image_compare.h"
#include "engine/scene/scene_file.h"

namespace {

namespace fs = std::filesystem;

struct RerunOptions {
    std::string picture, output;
    bool check = false, quiet = false;
    edgesplat::DeviceChoice device;
};

std::string text_of(const edgesplat::ImageMetadata& metadata, std::string_view name) {
    const auto found = std::find_if(metadata.begin(), metadata.end(), [&](const auto& m) { return m.first == name; });
    return found == metadata.end() ? "" : found->second;
}

/// A temporary folder; the destructor deletes it.
class TemporaryFolder {
  public:
    TemporaryFolder() {
        std::string name = (fs::temp_directory_path() / "edgesplat-rerun-XXXXXX").string();
        if (!mkdtemp(name.data()))
            edgesplat::fail("{}: cannot create a folder here", fs::temp_directory_path().string());
        path = name;
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        fs::remove_all(path, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    fs::path path;
};

/// Compares the pixels bit by bit, so that NaN equals itself.
bool same_pixels(const edgesplat::Image& a, const edgesplat::Image& b) {
    return std::equal(a.pixels.begin(), a.pixels.end(), b.pixels.begin(), b.pixels.end(), [](float x, float y) {
        return std::bit_cast<std::uint32_t>(x) == std::bit_cast<std::uint32_t>(y);
    });
}

/// Fails if the new picture differs. The message states the difference, and changes of program or device.
void compare(const RerunOptions& options, const edgesplat::LoadedImage& old, const fs::path& again) {
    const edgesplat::LoadedImage fresh = edgesplat::read_image(again);
    if (same_pixels(old.image, fresh.image)) {
        if (!options.quiet) fmt::print("{}: rendered again, all pixels are identical\n", options.picture);
        return;
    }
    std::string others;
    for (const char* name : {"Software", "edgesplat:device"}) {
        const std::string before = text_of(old.metadata, name), now = text_of(fresh.metadata, name);
        if (before != now) others += fmt::format("; before: \"{}\", now: \"{}\"", before, now);
    }
    const edgesplat::ImageDifference d = edgesplat::compare_images(old.image, fresh.image, 0);
    edgesplat::fail("{}: rendered again, {:.4g} % of the pixels differ, by at most {:.3g} at pixel {},{}{}",
                    options.picture, 100 * d.share, d.max, d.x, d.y, others);
}

void run(const RerunOptions& options, const std::string& command_line) {
    if (options.output.empty() && !options.check)
        edgesplat::fail("{}: give -o FILE for the new picture, or --check to compare", options.picture);
    const edgesplat::LoadedImage old = edgesplat::read_image(options.picture);
    const std::string scene = text_of(old.metadata, "edgesplat:scene");
    if (scene.empty())
        edgesplat::fail("{}: contains no scene; expected a picture written by `edgesplat render`", options.picture);

    PictureRequest request{.device = options.device, .command_line = command_line, .quiet = true};
    const fs::path folder = fs::path(options.picture).parent_path();
    request.folders = edgesplat::volume_folders({});
    request.folders.insert(request.folders.begin() + 1, folder);
    request.document =
        edgesplat::parse_scene(scene, options.picture + " (edgesplat:scene)", {.folders = request.folders});
    const auto make = [&](const fs::path& path) {
        PictureRequest one = request;
        one.document.output.file = path.string();
        make_picture(one);
    };
    if (!options.output.empty()) {
        make(options.output);
        if (!options.quiet) fmt::print("{}\n", options.output);
    }
    if (!options.check) return;
    // An output of the same format is compared directly; otherwise another one is rendered for the comparison.
    const std::string extension = edgesplat::is_png_path(options.picture) ? ".png" : ".exr";
    if (fs::path(options.output).extension() == extension) return compare(options, old, options.output);
    const TemporaryFolder temporary;
    const fs::path again = temporary.path / ("again" + extension);
    make(again);
    compare(options, old, again);
}

}  // namespace

void add_rerun_command(CLI::App& app, const std::string& command_line) {
    CLI::App& sub = *app.add_subcommand("rerun", "Render a picture again from the scene that it contains");
    const auto options = std::make_shared<RerunOptions>();
    sub.add_option("PICTURE", options->picture, "A .png or .exr that `edgesplat render` wrote")
        ->required()
        ->type_name("");
    sub.add_option("-o,--output", options->output, "The new picture: .png or .exr")->type_name("FILE");
    sub.add_flag("--check", options->check, "Compare with the picture; any pixel that differs is an error");
    sub.add_option("--device", options->device.device,
                   "Vulkan device: its number in --list-devices or a part of its name")
        ->type_name("DEVICE");
    sub.add_flag("-q,--quiet", options->quiet, "Print only warnings and errors");
    sub.footer(
        "The volume is searched at its old path, beside the picture, and in the folders of EDGESPLAT_VOLUMES.\n"
        "A volume with different samples is refused. On the same device, with the same version, the new picture is\n"
        "identical bit for bit.");
    sub.callback([options, command_line] { run(*options, command_line); });
}

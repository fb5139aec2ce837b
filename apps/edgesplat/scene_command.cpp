#include "apps/edgesplat/scene_command.h"

#include <fmt/format.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "apps/edgesplat/render_command.h"
#include "apps/edgesplat/volume_options.h"
#include "engine/error.h"
#include "engine/image/image_file.h"
#include "engine/scene/default_materials.h"
#include "engine/scene/scene_file.h"
#include "engine/scene/scene_presets.h"
#include "engine/volume/analytic_volumes.h"
#include "engine/volume/load_volume.h"

namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 1> kSceneExtensions{".toml"};

struct NewOptions {
    std::vector<std::string> sources;  ///< volumes or scene files
    std::string output;                ///< the new file
    DocumentEdits edits;
    VolumeOptions volume;
};

/// The path relative to a scene file in `folder`; builtin, absolute and missing paths stay as they are.
std::string path_in_scene(const std::string& path, const fs::path& folder) {
    std::error_code ignored;
    if (edgesplat::is_builtin(path) || fs::path(path).is_absolute() ||
        !fs::exists(edgesplat::split_inner(path).file, ignored))
        return path;
    return fs::proximate(path, folder.empty() ? "." : folder).string();
}

/// Makes the files of a volume, found in `folders`, relative to the scene file's folder.
void place_in_scene(edgesplat::VolumeSource& volume, const std::vector<fs::path>& folders, const fs::path& folder) {
    if (!edgesplat::is_builtin(volume.path))
        volume.path = path_in_scene(edgesplat::find_volume(volume.path, folders), folder);
    for (std::string* file : volume.other_files())
        if (!file->empty()) *file = path_in_scene(*file, folder);
}

/// Writes out the surfaces and materials of a volume. `scene`: of the volume alone.
void write_out_matter(edgesplat::SceneDocument& document, const edgesplat::Scene& scene,
                      const edgesplat::Volume& volume) {
    if (!document.volume.visible) return;
    write_out_materials(document, scene, volume);
    document.iso_sigmas.clear();
    // Leave open what the user did not choose: the material below all surfaces, and the colours of labels.
    if (document.below == choice_of(edgesplat::Material{.color = glm::dvec3(0)})) document.below = {};
    if (!scene.transfer.empty()) {
        document.transfer = scene.transfer;
        document.materials.clear();
    }
}

void run_new(const NewOptions& options) {
    if (!options.output.empty()) edgesplat::check_output_path(options.output, kSceneExtensions);
    edgesplat::SceneDocument document;
    std::vector<fs::path> folders;
    read_sources(options.sources, document, folders);
    apply(options.volume, document.volume);
    options.edits.apply(document);
    edgesplat::Volume volume = load_with_progress(document, folders, false);
    const edgesplat::Scene scene = resolve_scene(document, volume);
    const edgesplat::Camera camera = resolve_camera(document, volume, scene);
    write_out_matter(document, scene, volume);
    for (std::size_t i = 0; i < document.volumes.size(); ++i)
        write_out_matter(document.volumes[i], scene_of_volume(scene, i + 1), *scene.added[i].volume);
    // The same camera, bit for bit, as numbers that can be edited.
    document.camera = {.eye = camera.eye, .direction = camera.direction, .up = camera.up, .fov = camera.fov_y};
    const fs::path folder = fs::path(options.output).parent_path();
    place_in_scene(document.volume, folders, folder);
    for (edgesplat::SceneDocument& entry : document.volumes)
        place_in_scene(entry.volume, folders, folder);
    check_path_is_text(document);
    const std::string text = commented_scene_text(document);
    if (options.output.empty()) {
        fmt::print("{}", text);
    } else {
        const edgesplat::FileContent file{options.output, text};
        edgesplat::write_files({&file, 1});
    }
}

void run_check(const std::vector<std::string>& paths, int& exit_status) {
    for (const std::string& path : paths) {
        try {
            edgesplat::read_scene_file(path);
            fmt::print("{}: valid\n", path);
        } catch (const edgesplat::SceneFileError& error) {
            for (const std::string& problem : error.problems())
                fmt::print(stderr, "{}\n", problem);
            exit_status = 1;
        }
    }
}

void print_presets() {
    constexpr std::array<std::string_view, 3> kKinds{"material", "transfer", "look"};
    std::string text;
    for (const std::string& name : edgesplat::scene_preset_names()) {
        const edgesplat::ScenePreset preset = edgesplat::scene_preset(name);
        text += fmt::format("{:<26}{:<10}{}\n{:26}{}\n", name, kKinds.at(static_cast<std::size_t>(preset.kind)),
                            preset.file, "", preset.content.about);
    }
    fmt::print("{}", text);
}

}  // namespace

void add_scene_command(CLI::App& app, int& exit_status) {
    CLI::App& scene = *app.add_subcommand("scene", "Write, check and explain scene files (docs/scene_files.md)");
    scene.require_subcommand(1);

    CLI::App& make = *scene.add_subcommand("new", "Write a new scene file with every key explained");
    const auto options = std::make_shared<NewOptions>();
    make.add_option(
            "VOLUME", options->sources,
            "A volume file, a folder or pattern of slices, builtin:NAME, or a scene file (.toml). The options are "
            "those of `edgesplat render`, which draws the same picture from the new file")
        ->required()
        ->type_name("");
    make.add_option("-o,--output", options->output, "The scene file, .toml; default: stdout")->type_name("FILE");
    add_document_options(make, options->edits, options->volume);
    make.callback([options] { run_new(*options); });

    CLI::App& check = *scene.add_subcommand("check", "Report every error in scene files");
    const auto paths = std::make_shared<std::vector<std::string>>();
    check.add_option("SCENE", *paths, "Scene files (.toml)")->required()->type_name("");
    check.footer("Exit status: 0 all files are valid, 1 there are errors.");
    check.callback([paths, &exit_status] { run_check(*paths, exit_status); });

    CLI::App& keys = *scene.add_subcommand("keys", "List all keys of scene files");
    const auto markdown = std::make_shared<bool>(false);
    keys.add_flag("--markdown", *markdown, "Print the table of docs/scene_files.md");
    keys.callback(
        [markdown] { fmt::print("{}", *markdown ? edgesplat::scene_keys_markdown() : edgesplat::scene_keys_text()); });

    CLI::App& presets = *scene.add_subcommand("presets", "List the named looks, materials and transfer functions");
    presets.footer(
        "--look accepts any of them, --material only materials, --transfer only transfer functions. Presets are\n"
        "searched in the folders of EDGESPLAT_PRESETS, in $XDG_CONFIG_HOME/edgesplat/presets, and in the program.");
    presets.callback(print_presets);
}

#include "apps/edgesplat/render_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>

#include "apps/device_options.h"
#include "apps/edgesplat/camera_options.h"
#include "apps/edgesplat/effects_options.h"
#include "apps/edgesplat/explain_option.h"
#include "apps/edgesplat/max_error_option.h"
#include "apps/edgesplat/picture.h"
#include "apps/edgesplat/renderer_option.h"
#include "apps/edgesplat/scene_options.h"
#include "apps/edgesplat/volume_options.h"
#include "engine/error.h"
#include "engine/scene/scene_file.h"
#include "engine/volume/analytic_volumes.h"

namespace {

using edgesplat::SceneDocument;

/// Values of the command line.
struct RenderCommand {
    std::vector<std::string> sources;  ///< volumes or scene files
    VolumeOptions volume;
    DocumentEdits edits;
    std::string json;
    edgesplat::DeviceChoice device;
    ExplainOption explain;
    bool quiet = false;
};

void run(const RenderCommand& command, const std::string& command_line) {
    PictureRequest request{.device = command.device,
                           .explain = command.explain,
                           .json = command.json,
                           .command_line = command_line,
                           .quiet = command.quiet};
    read_sources(command.sources, request.document, request.folders);
    apply(command.volume, request.document.volume);
    command.edits.apply(request.document);
    if (request.document.output.file.empty() && !command.explain.explain) throw CLI::RequiredError("--output");
    make_picture(request);
}

void add_output_options(CLI::App& app, RenderCommand& command) {
    constexpr const char* kGroup = "Output";
    DocumentEdits& edits = command.edits;
    app.add_option_function<std::string>(
           "-o,--output",
           [&edits](const std::string& file) { edits.add([file](SceneDocument& d) { d.output.file = file; }); },
           "Output picture: .png (8-bit sRGB) or .exr (float32 linear, with alpha). Required unless the scene file "
           "names it or --explain is given")
        ->type_name("FILE")
        ->group(kGroup);
    CLI::Option* aov = app.add_option_function<std::vector<std::string>>(
                              "--aov",
                              [&edits](const std::vector<std::string>& aovs) {
                                  edits.add([aovs](SceneDocument& d) {
                                      d.output.aovs = aovs;
                                      d.output.compare_plain = d.output.compare_raycast = false;
                                  });
                              },
                              "Extra outputs, comma-separated: channels of an .exr picture, or separate files "
                              "(FILE.tau.exr, ...) beside a .png")
                           ->type_name(fmt::format("{}", fmt::join(edgesplat::aov_names(), ",")))
                           ->delimiter(',')
                           ->allow_extra_args(false)
                           ->check(CLI::IsMember(edgesplat::aov_names()).description(""))
                           ->group(kGroup);
    app.add_option_function<std::vector<std::string>>(
           "--compare",
           [&edits](const std::vector<std::string>& beside) {
               edits.add([beside](SceneDocument& d) {
                   d.output.compare_plain = std::ranges::count(beside, "plain") > 0;
                   d.output.compare_raycast = std::ranges::count(beside, "raycast") > 0;
                   d.output.aovs.clear();
               });
           },
           "Pictures to the left of this command's picture, comma-separated. plain: conventional splatting; raycast: "
           "the ray caster (--raycast-filter)")
        ->type_name("plain,raycast")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->check(CLI::IsMember(std::vector<std::string>{"plain", "raycast"}).description(""))
        ->excludes(aov)
        ->group(kGroup);
    app.add_option("--json", command.json,
                   "Write statistics: milliseconds per pass, counts, memory, device, driver, version")
        ->type_name("FILE")
        ->group(kGroup);
    app.add_flag("-q,--quiet", command.quiet, "Print only warnings and errors")->group(kGroup);
}

void add_set_option(CLI::App& app, DocumentEdits& edits) {
    app.add_option_function<std::vector<std::string>>(
           "--set",
           [&edits](const std::vector<std::string>& assignments) {
               for (const std::string& text : assignments)
                   edits.add([text](SceneDocument& d) {
                       try {
                           edgesplat::set_key(d, text);
                       } catch (const edgesplat::Error& error) {
                           edgesplat::fail("--set {}", error.what());
                       }
                   });
           },
           "Set any key of a scene file (`edgesplat scene keys`), such as effects.fog.start=20. Repeatable; applied "
           "after all other options")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false)
        ->group("Scene file");
}

}  // namespace

void add_document_options(CLI::App& app, DocumentEdits& edits, VolumeOptions& volume) {
    add_camera_options(app, edits);
    add_scene_options(app, edits);
    add_effects_options(app, edits);
    add_renderer_options(app, edits);
    add_max_error_option(app, edits);
    add_settings_options(app, edits);
    add_volume_options(app, volume);
    add_set_option(app, edits);
}

void read_source(const std::string& source, SceneDocument& document, std::vector<std::filesystem::path>& folders) {
    if (edgesplat::is_scene_path(source)) {
        document = edgesplat::read_scene_file(source);
        folders = edgesplat::volume_folders(std::filesystem::path(source).parent_path());
    } else {
        document.volume.path = source;
        folders = edgesplat::volume_folders({});
    }
}

namespace {

/// Adds the volume of a document as one beside the first; `folders` were searched for its files. `apart`: its paths
/// must not depend on the working folder.
void add_volume(SceneDocument& document, const SceneDocument& other, const std::vector<std::filesystem::path>& folders,
                bool apart) {
    const auto place = [&](const std::string& path) { return apart ? std::filesystem::absolute(path).string() : path; };
    SceneDocument& entry = document.volumes.emplace_back();
    entry.volume = other.volume;
    entry.iso_values = other.iso_values;
    entry.iso_sigmas = other.iso_sigmas;
    entry.below = other.below;
    entry.materials = other.materials;
    entry.transfer = other.transfer;
    entry.transfer_preset = other.transfer_preset;
    std::string& path = entry.volume.path;
    if (!edgesplat::is_builtin(path)) path = place(edgesplat::find_volume(path, folders));
    for (std::string* file : entry.volume.other_files())
        if (!file->empty()) *file = place(edgesplat::find_file(*file, folders).string());
}

}  // namespace

void read_sources(const std::vector<std::string>& sources, SceneDocument& document,
                  std::vector<std::filesystem::path>& folders) {
    read_source(sources.front(), document, folders);
    const bool apart = edgesplat::is_scene_path(sources.front());
    for (std::size_t i = 1; i < sources.size(); ++i) {
        SceneDocument other;
        std::vector<std::filesystem::path> of_other;
        read_source(sources[i], other, of_other);
        add_volume(document, other, of_other, apart);
        for (const SceneDocument& entry : other.volumes)
            add_volume(document, entry, of_other, apart);
    }
}

void add_render_command(CLI::App& app, const std::string& command_line) {
    CLI::App& sub = *app.add_subcommand("render", "Render a volume or a scene file to a picture");
    const auto command = std::make_shared<RenderCommand>();
    sub.add_option("VOLUME", command->sources,
                   "A volume file, a folder or pattern of slices, builtin:NAME, or a scene file (.toml), which the "
                   "options below change. More than one: their matter is drawn in one picture; options and camera are "
                   "those of the first")
        ->required()
        ->type_name("");
    add_output_options(sub, *command);
    add_document_options(sub, command->edits, command->volume);
    add_device_options(sub, command->device);
    add_explain_options(sub, command->explain);
    sub.footer(
        "Examples:\n"
        "  edgesplat render builtin:sphere -o sphere.png --compare plain\n"
        "  edgesplat render head.nrrd --iso -400 -o head.png --view close --size 800x600\n"
        "  edgesplat render head.nrrd --iso -400 -o nose.png --voxel --eye 128,148,14 --direction 0,1,0.05 --fov 90\n"
        "  edgesplat render head.nrrd --iso=-400,300 --color 1,.8,.7 --color 1,1,.9 --extinction .1 --extinction 8 -o "
        "two.exr --aov depth,normal\n"
        "  edgesplat render ct.nii.gz tumour.nii.gz -o both.png --iso 300\n"
        "  edgesplat render cut.toml -o cut.png --fog 0.01 --set effects.fog.start=50");
    sub.callback([command, command_line] { run(*command, command_line); });
}

#include "apps/edgesplat/camera_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "engine/scene/views.h"

using edgesplat::SceneDocument;

CLI::Option* add_size_option(CLI::App& command, DocumentEdits& edits) {
    return command
        .add_option_function<std::string>(
            "--size",
            [&edits](const std::string& text) {
                const std::optional<glm::ivec2> size = parse_size(text);
                if (!size)
                    throw CLI::ValidationError(
                        "--size", fmt::format("'{}' is not WxH with 1 to 16384 pixels each, such as 800x600", text));
                edits.add([size](SceneDocument& d) { d.output.size = *size; });
            },
            "Picture size, pixels")
        ->type_name("WxH")
        ->default_str("512x512");
}

void add_camera_options(CLI::App& command, DocumentEdits& edits) {
    constexpr const char* kGroup = "Camera";
    std::vector<std::string> views;
    for (const std::string_view name : edgesplat::view_names())
        views.emplace_back(name);
    CLI::Option* view =
        command
            .add_option_function<std::string>(
                "--view",
                [&edits, views](const std::string& text) {
                    if (std::find(views.begin(), views.end(), text) == views.end())
                        throw CLI::ValidationError("--view", fmt::format("unknown view '{}'; expected one of {}", text,
                                                                         fmt::join(views, ", ")));
                    edits.add([text](SceneDocument& d) { d.camera = {.view = text, .fov = d.camera.fov}; });
                },
                "Named camera that frames all visible matter; close: near a surface. Default: front for patients and "
                "builtin volumes, otherwise the most informative view along an axis")
            ->type_name(fmt::format("{}", fmt::join(views, "|")))
            ->group(kGroup);
    CLI::Option* eye = add_vector_edit(command, edits, "--eye", "X,Y,Z", "Position of the eye, world mm",
                                       [](SceneDocument& d, const glm::dvec3& p) {
                                           d.camera.eye = p;
                                           d.camera.view.clear();
                                       });
    CLI::Option* target = add_vector_edit(command, edits, "--target", "X,Y,Z",
                                          "Point that the eye looks at, world mm; default: the volume's centre",
                                          [](SceneDocument& d, const glm::dvec3& p) {
                                              d.camera.target = p;
                                              d.camera.direction.reset();
                                          });
    CLI::Option* direction = add_vector_edit(command, edits, "--direction", "X,Y,Z",
                                             "View direction; without --eye the whole volume is framed",
                                             [](SceneDocument& d, const glm::dvec3& v) {
                                                 d.camera.direction = v;
                                                 d.camera.target.reset();
                                                 d.camera.view.clear();
                                             });
    add_vector_edit(command, edits, "--up", "X,Y,Z", "Up direction of the picture; default 0,0,1",
                    [](SceneDocument& d, const glm::dvec3& v) { d.camera.up = v; })
        ->group(kGroup);
    add_flag_edit(command, edits, "--voxel",
                  "--eye and --target are voxel indices; --direction and --up refer to the volume's axes",
                  [](SceneDocument& d) { d.camera.voxel = true; })
        ->group(kGroup);
    add_number_edit(command, edits, "--fov", {0.1, 179}, "Full vertical field of view, degrees",
                    [](SceneDocument& d, double value) { d.camera.fov = value; })
        ->default_str("45")
        ->group(kGroup);
    add_size_option(command, edits)->group(kGroup);
    view->excludes(eye)->excludes(direction);
    direction->excludes(target)->group(kGroup);
    target->group(kGroup);
    eye->group(kGroup);
}

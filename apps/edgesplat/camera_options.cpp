#include "apps/edgesplat/camera_options.h"

#include <fmt/format.h>

#include <vector>

#include "apps/edgesplat/option_values.h"
#include "engine/error.h"

void add_camera_options(CLI::App& command, CameraOptions& options) {
    std::vector<std::string> views;
    for (const std::string_view name : edgesplat::view_names())
        views.emplace_back(name);
    CLI::Option* view =
        command
            .add_option("--view", options.view,
                        "A named camera that shows the whole volume; close: near the first surface")
            ->type_name(fmt::format("{}", fmt::join(views, "|")))
            ->default_str("front")
            ->check([views](const std::string& text) {
                for (const std::string& name : views)
                    if (name == text) return std::string();
                return fmt::format("no view is called '{}'; there are {}", text, fmt::join(views, ", "));
            });
    CLI::Option* eye = add_vector(command, "--eye", options.eye, "X,Y,Z", "Where the eye is, world mm");
    CLI::Option* target = add_vector(command, "--target", options.target, "X,Y,Z",
                                     "What the eye looks at, world mm; default: the volume's centre");
    CLI::Option* direction = add_vector(command, "--direction", options.direction, "X,Y,Z",
                                        "Which way the eye looks; without --eye the whole volume is framed");
    add_vector(command, "--up", options.up, "X,Y,Z", "What is up in the picture; default 0,0,1")->group("Camera");
    command
        .add_flag("--voxel", options.voxel,
                  "--eye and --target are voxel indices, --direction and --up run along the volume's axes")
        ->group("Camera");
    add_number(command, "--fov", options.fov, {0.1, 179}, "Full vertical angle, degrees")->group("Camera");
    command
        .add_option_function<std::string>(
            "--size",
            [&options](const std::string& text) {
                const std::optional<glm::ivec2> size = parse_size(text);
                if (!size)
                    throw CLI::ValidationError(
                        "--size", fmt::format("'{}' is not WxH with 1 to 16384 pixels each, such as 800x600", text));
                options.size = *size;
            },
            "Pixels")
        ->type_name("WxH")
        ->default_str("512x512")
        ->group("Camera");
    view->excludes(eye)->excludes(direction)->group("Camera");
    direction->excludes(target)->group("Camera");
    target->needs(eye)->group("Camera");
    eye->group("Camera");
}

edgesplat::Camera camera_from_options(const CameraOptions& options, const edgesplat::Volume& volume,
                                      const edgesplat::Scene& scene) {
    const edgesplat::VolumeGeometry& geometry = volume.geometry;
    const edgesplat::ViewRequest request{&volume, &scene, options.fov, options.size.x, options.size.y};
    const auto point = [&](const glm::dvec3& p) { return options.voxel ? geometry.to_world(p) : p; };
    const auto along = [&](const glm::dvec3& v) { return options.voxel ? edgesplat::volume_axes(geometry) * v : v; };
    for (const auto& [name, vector] : {std::pair{"--direction", options.direction}, {"--up", options.up}})
        if (vector && glm::length(*vector) == 0) edgesplat::fail("{} must not be 0,0,0", name);

    const glm::dvec3 up = along(options.up.value_or(glm::dvec3(0, 0, 1)));
    if (options.eye) {
        const glm::dvec3 eye = point(*options.eye);
        const glm::dvec3 center = geometry.to_world((glm::dvec3(geometry.dims) - 1.0) / 2.0);
        const glm::dvec3 direction =
            options.direction ? along(*options.direction) : (options.target ? point(*options.target) : center) - eye;
        if (glm::length(direction) == 0)
            edgesplat::fail("--eye is where the eye looks at ({}); give another --target, or a --direction",
                            options.target ? "--target" : "the volume's centre");
        return {eye, direction, up, options.fov};
    }
    if (options.direction) return edgesplat::framing_camera(along(*options.direction), up, request);
    edgesplat::Camera camera = edgesplat::named_view(options.view.empty() ? "front" : options.view, request);
    if (options.up) camera.up = up;
    return camera;
}

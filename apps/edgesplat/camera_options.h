// Where the eye stands and what it looks at, from the command line.
#pragma once

#include <CLI/CLI.hpp>
#include <glm/glm.hpp>
#include <optional>
#include <string>

#include "engine/scene/views.h"

/// What the command line said about the camera; see `camera_from_options` for how it fits together.
struct CameraOptions {
    std::optional<glm::dvec3> eye, target, direction, up;
    bool voxel = false;  ///< eye and target are voxel indices; direction and up run along the volume's own axes, in mm
    double fov = 45;     ///< full vertical angle, degrees
    std::string view;    ///< empty: not given
    glm::ivec2 size{512, 512};
};

/// Adds --view, --eye, --target, --direction, --up, --voxel, --fov and --size.
void add_camera_options(CLI::App& command, CameraOptions& options);

/// --view gives a camera; without it --eye does, looking along --direction, at --target, or at the volume's centre;
/// --direction alone frames the volume. With none of them: the front view. --up replaces the up direction of any.
edgesplat::Camera camera_from_options(const CameraOptions& options, const edgesplat::Volume& volume,
                                      const edgesplat::Scene& scene);

// Renders a scene to the files of its picture; used by `render`, `rerun` and others.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "apps/edgesplat/explain_option.h"
#include "apps/edgesplat/render_output.h"
#include "engine/renderer.h"
#include "engine/scene/scene_document.h"

/// Request for a picture.
struct PictureRequest {
    edgesplat::SceneDocument document;           ///< `output.file` is the picture's path
    std::vector<std::filesystem::path> folders;  ///< searched for the volume
    edgesplat::DeviceChoice device;
    ExplainOption explain;  ///< without an output file only the plan is printed
    std::string json;       ///< path of the statistics; empty: none
    std::string command_line;
    bool quiet = false;
};

/// Checks the request, reads the volume, renders, writes all files or none, and prints a summary line. Throws
/// edgesplat::Error.
void make_picture(PictureRequest request);

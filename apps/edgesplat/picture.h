// From a scene to the files of its picture: what `render`, `rerun` and others share.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "apps/edgesplat/explain_option.h"
#include "apps/edgesplat/render_output.h"
#include "engine/renderer.h"
#include "engine/scene/scene_document.h"

/// A picture to be made.
struct PictureRequest {
    edgesplat::SceneDocument document;           ///< its `output.file` is where the picture goes
    std::vector<std::filesystem::path> folders;  ///< where the volume is looked for
    edgesplat::DeviceChoice device;
    ExplainOption explain;  ///< with no output file: only the plan is printed
    std::string json;       ///< where statistics go; empty: nowhere
    std::string command_line;
    bool quiet = false;
};

/// Checks everything that can be checked before, reads the volume, renders, writes all files or none, and says in one
/// line what was done. Throws edgesplat::Error.
void make_picture(PictureRequest request);

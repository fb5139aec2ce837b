// Where the eye stands and what it looks at, from the command line.
#pragma once

#include <CLI/CLI.hpp>

#include "apps/edgesplat/document_edits.h"

/// Adds --view, --eye, --target, --direction, --up, --voxel, --fov and --size. How they fit together:
/// edgesplat::CameraChoice.
void add_camera_options(CLI::App& command, DocumentEdits& edits);

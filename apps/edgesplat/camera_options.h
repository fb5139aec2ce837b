// Camera options of the command line.
#pragma once

#include <CLI/CLI.hpp>

#include "apps/edgesplat/document_edits.h"

/// Adds --view, --eye, --target, --direction, --up, --voxel, --fov and --size. edgesplat::CameraChoice says how they
/// combine.
void add_camera_options(CLI::App& command, DocumentEdits& edits);

/// Adds --size, of the picture.
CLI::Option* add_size_option(CLI::App& command, DocumentEdits& edits);

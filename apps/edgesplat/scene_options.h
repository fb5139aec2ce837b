// What is to be seen, and how accurately, from the command line.
#pragma once

#include <CLI/CLI.hpp>

#include "apps/edgesplat/document_edits.h"

/// Adds --iso, --material, --color, --extinction, --background, --light, --ambient, --threshold and --box-filter.
void add_scene_options(CLI::App& command, DocumentEdits& edits);

/// Adds --preset and every knob of the ladder (engine/scene/ladder.h).
void add_settings_options(CLI::App& command, DocumentEdits& edits);

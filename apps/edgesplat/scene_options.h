// Scene and accuracy options of the command line.
#pragma once

#include <CLI/CLI.hpp>

#include "apps/edgesplat/document_edits.h"

/// Adds --look, --transfer, --iso, --material, --color, --extinction, --background, --light, --ambient, --threshold,
/// --box-filter and --labels.
void add_scene_options(CLI::App& command, DocumentEdits& edits);

/// Adds --preset, every knob of the ladder (engine/scene/ladder.h) and --keep-buried.
void add_settings_options(CLI::App& command, DocumentEdits& edits);

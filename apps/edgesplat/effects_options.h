// Effects from the command line; what each means: engine/scene/effects.h.
#pragma once

#include <CLI/CLI.hpp>

#include "apps/edgesplat/document_edits.h"

/// Adds --fog, --silhouette, --occlusion, --shadows, --clip-plane, --clip-box, --cut-box, --antialias, --samples,
/// --background-top and --overlay. After the options of scene_options.h, whose lights --shadows changes.
void add_effects_options(CLI::App& command, DocumentEdits& edits);

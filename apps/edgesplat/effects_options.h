// Effect options of the command line; engine/scene/effects.h explains the effects.
#pragma once

#include <CLI/CLI.hpp>

#include "apps/edgesplat/document_edits.h"

/// Adds --fog, --silhouette, --occlusion, --shadows, --clip-plane, --clip-box, --cut-box, --antialias,
/// --smooth-outlines, --samples, --background-top and --overlay. Call it after add_scene_options: --shadows changes the
/// lights set there.
void add_effects_options(CLI::App& command, DocumentEdits& edits);

// --renderer, --raycast-step, --raycast-filter and --tolerance of `edgesplat render`: which way to the picture.
#pragma once

#include <CLI/CLI.hpp>

#include "apps/edgesplat/document_edits.h"
#include "engine/renderer.h"

/// How the ray caster is to sample.
edgesplat::RaycastSettings raycast_settings(const edgesplat::OutputChoice& output);

/// Adds --renderer, --raycast-step, --raycast-filter and --tolerance.
void add_renderer_options(CLI::App& command, DocumentEdits& edits);

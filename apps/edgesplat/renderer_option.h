// Options --renderer, --raycast-step, --raycast-filter and --tolerance: how a picture is computed.
#pragma once

#include <CLI/CLI.hpp>

#include "apps/edgesplat/document_edits.h"
#include "engine/renderer.h"

/// Sampling settings of the ray caster.
edgesplat::RaycastSettings raycast_settings(const edgesplat::OutputChoice& output);

/// Adds --renderer, --raycast-step, --raycast-filter and --tolerance.
void add_renderer_options(CLI::App& command, DocumentEdits& edits);

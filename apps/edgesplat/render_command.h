// `edgesplat render VOLUME|SCENE.toml -o PICTURE`: one picture, with everything that can be said about it.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "apps/edgesplat/document_edits.h"
#include "apps/edgesplat/volume_options.h"
#include "engine/renderer.h"

/// Adds the command. `command_line` is recorded in what it writes. Its callback throws edgesplat::Error.
void add_render_command(CLI::App& app, const std::string& command_line);

/// Adds everything that a command line can say about a scene: volume, camera, matter, effects, renderer, quality, and
/// --set, which has the last word.
void add_document_options(CLI::App& app, DocumentEdits& edits, VolumeOptions& volume);

/// Fills `document` from a scene file, or begins one for a volume, and says where its volume is looked for. Throws
/// edgesplat::Error.
void read_source(const std::string& source, edgesplat::SceneDocument& document,
                 std::vector<std::filesystem::path>& folders);

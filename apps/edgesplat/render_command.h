// Command `edgesplat render VOLUME|SCENE.toml -o PICTURE`: renders one picture. Also the scene options of other
// commands.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "apps/edgesplat/document_edits.h"
#include "apps/edgesplat/volume_options.h"
#include "engine/renderer.h"

/// Adds the command. Output files record `command_line`. The callback throws edgesplat::Error.
void add_render_command(CLI::App& app, const std::string& command_line);

/// Adds all scene options: volume, camera, materials, effects, renderer, quality, and --set, which is applied last.
void add_document_options(CLI::App& app, DocumentEdits& edits, VolumeOptions& volume);

/// Reads a scene file into `document`, or starts a scene for a volume. `folders` receives the folders to search for the
/// volume. Throws edgesplat::Error.
void read_source(const std::string& source, edgesplat::SceneDocument& document,
                 std::vector<std::filesystem::path>& folders);

/// The same for several: the volumes of the others are drawn beside the first one.
void read_sources(const std::vector<std::string>& sources, edgesplat::SceneDocument& document,
                  std::vector<std::filesystem::path>& folders);

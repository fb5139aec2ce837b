// `edgesplat scene new|check|keys|presets`: scene files, and what can stand in them.
#pragma once

#include <CLI/CLI.hpp>

/// Adds the command. `exit_status` becomes 1 where a checked file has problems. Its callbacks throw edgesplat::Error.
void add_scene_command(CLI::App& app, int& exit_status);

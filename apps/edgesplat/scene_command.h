// Commands `edgesplat scene new|check|keys|presets`: write, check and explain scene files.
#pragma once

#include <CLI/CLI.hpp>

/// Adds the command. `exit_status` becomes 1 if a checked file has errors. The callbacks throw edgesplat::Error.
void add_scene_command(CLI::App& app, int& exit_status);

// `edgesplat movie VOLUME|SCENE.toml -o FILM|FRAMES`: a camera's way as a film or as numbered pictures, resumable.
#pragma once

#include <CLI/CLI.hpp>

/// Adds the command. `exit_status` becomes 130 where Ctrl-C stopped it. Its callback throws edgesplat::Error.
void add_movie_command(CLI::App& app, int& exit_status);

// Command `edgesplat movie VOLUME|SCENE.toml -o FILM|FRAMES`: renders a camera path to a film or to numbered pictures.
// A stopped run can be continued.
#pragma once

#include <CLI/CLI.hpp>

/// Adds the command. Ctrl-C sets `exit_status` to 130. The callback throws edgesplat::Error.
void add_movie_command(CLI::App& app, int& exit_status);

// `edgesplat compare A B`: how far two pictures are apart, for people and for scripts.
#pragma once

#include <CLI/CLI.hpp>

/// Adds the command. Its callback sets `exit_status` to 0 (within the limits) or 1 (not), or throws edgesplat::Error.
void add_compare_command(CLI::App& app, int& exit_status);

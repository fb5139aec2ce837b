// Command `edgesplat compare A B`: measures the difference of two pictures; scripts read the exit status.
#pragma once

#include <CLI/CLI.hpp>

/// Adds the command. The callback sets `exit_status` to 0 (within the limits) or 1 (not), or throws edgesplat::Error.
void add_compare_command(CLI::App& app, int& exit_status);

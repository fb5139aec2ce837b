// `edgesplat check`: reads all volumes under files and folders and prints a table of what they contain.
#pragma once

#include <CLI/CLI.hpp>

/// Sets `exit_status` to 1 if a volume is refused.
void add_check_command(CLI::App& app, int& exit_status);

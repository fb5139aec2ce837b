// `edgesplat accuracy VOLUME --report DIR`: what accuracy costs in time, measured on a volume of the user's.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

/// Adds the command. `command_line` is recorded in what it writes; `exit_status` becomes 130 where it was stopped by
/// Ctrl-C. Its callback throws edgesplat::Error.
void add_accuracy_command(CLI::App& app, const std::string& command_line, int& exit_status);

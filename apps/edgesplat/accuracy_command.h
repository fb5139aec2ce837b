// Command `edgesplat accuracy VOLUME --report DIR`: measures error and time of the accuracy settings on a volume.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

/// Adds the command. The report records `command_line`. Ctrl-C sets `exit_status` to 130. The callback throws
/// edgesplat::Error.
void add_accuracy_command(CLI::App& app, const std::string& command_line, int& exit_status);

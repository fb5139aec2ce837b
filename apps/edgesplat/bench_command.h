// Command `edgesplat bench`: measures a suite of cases, or compares two measurements.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

/// Adds the command. Results record `command_line`. Ctrl-C sets `exit_status` to 130. The callback throws
/// edgesplat::Error.
void add_bench_command(CLI::App& app, const std::string& command_line, int& exit_status);

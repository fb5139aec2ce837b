// `edgesplat bench`
#pragma once

#include <CLI/CLI.hpp>
#include <string>

/// `exit_status` is 130 after Ctrl-C.
void add_bench_command(CLI::App& app, const std::string& command_line, int& exit_status);

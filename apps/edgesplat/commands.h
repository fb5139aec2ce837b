// All commands of the program.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

/// Adds every command and the options of the program itself. `command_line` goes into what the commands write of how it
/// was made; `exit_status` is set by commands that tell by it, and must outlive the parse.
void add_commands(CLI::App& app, const std::string& command_line, int& exit_status);

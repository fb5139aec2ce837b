// Registers all commands of the program.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

/// Adds every command and the options of the program itself. Output files record `command_line`. Some commands set
/// `exit_status`, which must outlive the parse.
void add_commands(CLI::App& app, const std::string& command_line, int& exit_status);

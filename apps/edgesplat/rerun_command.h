// Command `edgesplat rerun PICTURE`: renders a picture again from the scene that it contains.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

/// Adds the command. Its callback throws edgesplat::Error, also if --check finds a difference.
void add_rerun_command(CLI::App& app, const std::string& command_line);

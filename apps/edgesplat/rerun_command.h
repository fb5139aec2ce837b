// `edgesplat rerun PICTURE`: makes a picture again from what it says about itself.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

/// Adds the command. Its callback throws edgesplat::Error, also where --check finds a difference.
void add_rerun_command(CLI::App& app, const std::string& command_line);

// Command `edgesplat footprints`: reports the accuracy of the footprint modes and plots the paper's figures.
#pragma once

#include <CLI/CLI.hpp>

/// Adds the command. The callback prints to stdout, writes plots, and throws edgesplat::Error.
void add_footprints_command(CLI::App& app);

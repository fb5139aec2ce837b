// `edgesplat footprints`: how accurate the footprint modes are, and the paper's figures drawn from our curves.
#pragma once

#include <CLI/CLI.hpp>

/// Adds the command. Its callback prints to stdout, writes plots, and throws edgesplat::Error.
void add_footprints_command(CLI::App& app);

// `edgesplat measure VOLUME`: volumes, surfaces, distances and angles, with what they are uncertain by.
#pragma once

#include <CLI/CLI.hpp>

/// Adds the command. Its callback prints to stdout (or writes JSON) and throws edgesplat::Error.
void add_measure_command(CLI::App& app);

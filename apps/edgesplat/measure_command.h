// Command `edgesplat measure VOLUME`: measures volumes, surfaces, distances and angles with their uncertainties.
#pragma once

#include <CLI/CLI.hpp>

/// Adds the command. The callback prints to stdout (or writes JSON) and throws edgesplat::Error.
void add_measure_command(CLI::App& app);

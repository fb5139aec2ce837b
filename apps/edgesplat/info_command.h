// Command `edgesplat info VOLUME`: prints a volume's properties and likely iso-values.
#pragma once

#include <CLI/CLI.hpp>

/// Adds the command. The callback prints to stdout (or writes JSON) and throws edgesplat::Error.
void add_info_command(CLI::App& app);

// `edgesplat info VOLUME`: what a volume is, and where its surfaces may lie.
#pragma once

#include <CLI/CLI.hpp>

/// Adds the command. Its callback prints to stdout (or writes JSON) and throws edgesplat::Error.
void add_info_command(CLI::App& app);

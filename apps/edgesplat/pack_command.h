// `edgesplat pack VOLUME -o vol.esv`: a volume in a file that is drawn from without being in memory.
#pragma once

#include <CLI/CLI.hpp>

/// Adds the command. Its callback sets `exit_status` where Ctrl-C stopped it, or throws edgesplat::Error.
void add_pack_command(CLI::App& app, int& exit_status);

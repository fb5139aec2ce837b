// Command `edgesplat pack VOLUME -o vol.esv`: writes a packed volume, which is rendered without loading all of it.
#pragma once

#include <CLI/CLI.hpp>

/// Adds the command. Ctrl-C sets `exit_status` to 130. The callback throws edgesplat::Error.
void add_pack_command(CLI::App& app, int& exit_status);

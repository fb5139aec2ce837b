// Command `edgesplat effects`: measures the cost of each effect of the table.
#pragma once

#include <CLI/CLI.hpp>

void add_effects_command(CLI::App& app);

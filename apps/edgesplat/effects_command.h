// `edgesplat effects`: what each effect of the table costs, measured.
#pragma once

#include <CLI/CLI.hpp>

void add_effects_command(CLI::App& app);

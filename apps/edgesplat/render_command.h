// `edgesplat render VOLUME -o PICTURE`: one picture of a volume, with everything that can be said about it.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

/// Adds the command. `command_line` is recorded in what it writes. Its callback throws edgesplat::Error.
void add_render_command(CLI::App& app, const std::string& command_line);

/// Prints every Vulkan device and why it cannot be used, if so.
void print_devices();

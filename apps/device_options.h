// Vulkan device options, shared by all programs.
#pragma once

#include <CLI/CLI.hpp>

#include "engine/renderer.h"

/// Adds --list-devices.
void add_device_list(CLI::App& app);

/// Adds --device, --device-profile, --list-devices, --validation and --check-numbers.
void add_device_options(CLI::App& app, edgesplat::DeviceChoice& choice);

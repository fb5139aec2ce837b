// Options about Vulkan devices, the same in every program.
#pragma once

#include <CLI/CLI.hpp>

#include "engine/renderer.h"

/// --list-devices.
void add_device_list(CLI::App& app);

/// --device, --device-profile, --list-devices, --validation, --check-numbers.
void add_device_options(CLI::App& app, edgesplat::DeviceChoice& choice);

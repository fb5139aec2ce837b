// The options every command that reads a volume shares, and the reading itself with progress on stderr.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "engine/volume/volume.h"

/// What the command line said about the volume; see `LoadOptions` for the meaning of each.
struct VolumeOptions {
    int component = -1;           ///< --component; -1: not given
    int frame = -1;               ///< --frame; -1: not given
    std::string series;           ///< --series
    std::string raw;              ///< --raw
    std::vector<double> spacing;  ///< --spacing X Y Z, mm; empty: not given
};

/// Adds --raw, --component, --frame, --series and --spacing to a command. `options` must outlive the parse.
void add_volume_options(CLI::App& command, VolumeOptions& options);

/// Reads a file, a folder, a slice pattern or "builtin:NAME". Unless `quiet`, a load that takes longer than a second
/// shows its progress on stderr. Throws edgesplat::Error naming the file and the reason.
edgesplat::Volume load_from_options(const std::string& path, const VolumeOptions& options, bool quiet);

// The options every command that reads a volume shares, and the reading itself with progress on stderr.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/scene/scene_document.h"

/// What the command line said about the volume; see `LoadOptions` for the meaning of each.
struct VolumeOptions {
    int component = -1;           ///< --component; -1: not given
    int frame = -1;               ///< --frame; -1: not given
    std::string series;           ///< --series
    std::string raw;              ///< --raw
    bool resample = false;        ///< --resample
    std::vector<double> spacing;  ///< --spacing X Y Z, mm; empty: not given
};

/// Adds --raw, --component, --frame, --series, --resample and --spacing to a command. `options` must outlive the parse.
void add_volume_options(CLI::App& command, VolumeOptions& options);

/// Puts what the command line said into a scene's volume.
void apply(const VolumeOptions& options, edgesplat::VolumeSource& source);

/// Finds, reads and preprocesses a scene's volume (engine/scene/scene_document.h). Unless `quiet`, a load that takes
/// longer than a second shows its progress on stderr; warnings are shown in any case. Throws edgesplat::Error naming
/// the file and the reason.
edgesplat::Volume load_with_progress(const edgesplat::VolumeSource& source,
                                     const std::vector<std::filesystem::path>& folders, bool quiet);

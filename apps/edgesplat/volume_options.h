// Volume options, shared by all commands that read a volume, and loading with progress on stderr.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/scene/scene_document.h"

/// Volume options of the command line; `LoadOptions` explains each.
struct VolumeOptions {
    int component = -1;             ///< --component; -1: not given
    int frame = -1;                 ///< --frame; -1: not given
    int level = -1;                 ///< --level; -1: not given
    std::string series;             ///< --series
    std::string raw;                ///< --raw
    bool resample = false;          ///< --resample
    std::vector<double> spacing;    ///< --spacing X Y Z, mm; empty: not given
    std::optional<double> no_data;  ///< --no-data
    std::string segmentation;       ///< --segmentation
    std::string label_names;        ///< --label-names
    std::string registration;       ///< --registration
};

/// Adds --raw, --component, --frame, --level, --series, --resample, --spacing, --no-data, --segmentation and
/// --label-names to a command. `options` must outlive the parse.
void add_volume_options(CLI::App& command, VolumeOptions& options);

/// Copies the given options into a scene's volume.
void apply(const VolumeOptions& options, edgesplat::VolumeSource& source);

/// Finds, reads and preprocesses a scene's volume (load_scene_volume). Unless `quiet`, loading shows its progress on
/// stderr after a second. Warnings are always printed. Throws edgesplat::Error naming the file and the reason.
edgesplat::Volume load_with_progress(edgesplat::SceneDocument& document,
                                     const std::vector<std::filesystem::path>& folders, bool quiet);
/// The same for a volume without a scene (load_source), and for another way to load.
edgesplat::Volume load_with_progress(const edgesplat::VolumeSource& source,
                                     const std::vector<std::filesystem::path>& folders, bool quiet);
edgesplat::Volume load_with_progress(const std::function<edgesplat::Volume(const edgesplat::LoadProgress&)>& load,
                                     bool quiet);

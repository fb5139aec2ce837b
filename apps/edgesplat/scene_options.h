// What is to be seen, and how accurately, from the command line.
#pragma once

#include <CLI/CLI.hpp>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/scene/scene.h"
#include "engine/scene/settings.h"
#include "engine/volume/volume.h"

/// What the command line said about surfaces, colours and light.
struct SceneOptions {
    std::vector<double> iso;         ///< volume's unit, in the order given
    std::vector<glm::dvec3> color;   ///< of the material from each iso-value up; empty: defaults
    std::vector<double> extinction;  ///< per mm, likewise
    std::optional<glm::dvec3> background;
    edgesplat::Light light;
    bool box_filter = false;
    std::optional<double> threshold;
};

/// Adds --iso, --color, --extinction, --background, --light, --threshold and --box-filter.
void add_scene_options(CLI::App& command, SceneOptions& options);

/// Adds --preset and every knob of the ladder (engine/scene/ladder.h).
void add_settings_options(CLI::App& command, edgesplat::Settings& settings);

/// Applies --threshold, then --box-filter, as the paper does with binary data.
void preprocess(const SceneOptions& options, edgesplat::Volume& volume);

/// The scene for a preprocessed volume. Without --iso: a builtin scene's own iso-values, 0.5 after --threshold, else
/// the strongest suggestion for the volume. Without --extinction: 8 per voxel of mean spacing for the highest material,
/// 0.15 per voxel for those below. What lies below the lowest iso-value is transparent. Throws edgesplat::Error.
edgesplat::Scene scene_from_options(const SceneOptions& options, const edgesplat::Volume& volume);

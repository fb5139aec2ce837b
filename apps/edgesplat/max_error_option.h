// --max-error of `edgesplat render`: the cheapest method that keeps the error of the picture below a limit.
#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <optional>

#include "engine/accuracy/choose_settings.h"
#include "engine/image_file.h"

struct MaxErrorOption {
    std::optional<double> rms;  ///< of full scale, (0, 1); empty: not given
};

/// Adds --max-error.
void add_max_error_option(CLI::App& command, MaxErrorOption& option);

/// Changes the method knobs of `settings` to what keeps the error, and says so unless `quiet`. Nothing happens where
/// the option was not given. Throws edgesplat::Error where no method is good enough.
std::optional<edgesplat::accuracy::ChosenSettings> apply_max_error(const MaxErrorOption& option,
                                                                   edgesplat::Renderer& renderer,
                                                                   const edgesplat::Volume& volume,
                                                                   const edgesplat::Scene& scene,
                                                                   const edgesplat::Camera& camera, glm::ivec2 size,
                                                                   edgesplat::Settings& settings, bool quiet);

/// What the picture's metadata ("edgesplat:error") and the statistics ("error") say of it.
void add_error_estimate(const std::optional<edgesplat::accuracy::ChosenSettings>& choice, const MaxErrorOption& option,
                        edgesplat::ImageMetadata& metadata, nlohmann::ordered_json& json);

// Option --max-error: chooses the fastest method whose error stays below a limit.
#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <optional>

#include "apps/edgesplat/document_edits.h"
#include "engine/accuracy/choose_settings.h"
#include "engine/image/image_file.h"

/// Adds --max-error.
void add_max_error_option(CLI::App& command, DocumentEdits& edits);

/// Sets the method in `settings` to the fastest one within the limit `max_error`, and prints the choice unless `quiet`.
/// Does nothing without a limit. Throws edgesplat::Error if no method is accurate enough.
std::optional<edgesplat::accuracy::ChosenSettings> apply_max_error(std::optional<double> max_error,
                                                                   edgesplat::Renderer& renderer,
                                                                   const edgesplat::Volume& volume,
                                                                   const edgesplat::Scene& scene,
                                                                   const edgesplat::Camera& camera, glm::ivec2 size,
                                                                   edgesplat::Settings& settings, bool quiet);

/// Adds the choice to the picture's metadata ("edgesplat:error") and to the statistics ("error").
void add_error_estimate(const std::optional<edgesplat::accuracy::ChosenSettings>& choice,
                        std::optional<double> max_error, edgesplat::ImageMetadata& metadata,
                        nlohmann::ordered_json& json);

// --max-error of `edgesplat render`: the cheapest method that keeps the error of the picture below a limit.
#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <optional>

#include "apps/edgesplat/document_edits.h"
#include "engine/accuracy/choose_settings.h"
#include "engine/image/image_file.h"

/// Adds --max-error.
void add_max_error_option(CLI::App& command, DocumentEdits& edits);

/// Changes the method knobs of `settings` to what keeps the error, and says so unless `quiet`. Nothing happens where
/// the scene names no limit (`max_error`). Throws edgesplat::Error where no method is good enough.
std::optional<edgesplat::accuracy::ChosenSettings> apply_max_error(std::optional<double> max_error,
                                                                   edgesplat::Renderer& renderer,
                                                                   const edgesplat::Volume& volume,
                                                                   const edgesplat::Scene& scene,
                                                                   const edgesplat::Camera& camera, glm::ivec2 size,
                                                                   edgesplat::Settings& settings, bool quiet);

/// What the picture's metadata ("edgesplat:error") and the statistics ("error") say of it.
void add_error_estimate(const std::optional<edgesplat::accuracy::ChosenSettings>& choice,
                        std::optional<double> max_error, edgesplat::ImageMetadata& metadata,
                        nlohmann::ordered_json& json);

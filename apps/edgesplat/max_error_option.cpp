#include "apps/edgesplat/max_error_option.h"

#include <exception>

#include <fmt/format.h>

#include "engine/scene/ladder.h"

namespace {

using edgesplat::accuracy::ChosenSettings;

std::string difference_text(const ChosenSettings& choice) {
    const std::string text = edgesplat::difference(choice.chosen.settings);
    return text.empty() ? "the default settings" : text;
}

}  // namespace

void add_max_error_option(CLI::App& command, DocumentEdits& edits) {
    command
        .add_option_function<std::string>(
            "--max-error",
            [&edits](const std::string& text) {
                try {
                    edits.add([share = edgesplat::accuracy::error_share(text)](edgesplat::SceneDocument& d) {
                        d.quality.max_error = share;
                    });
                } catch (const std::exception& error) {
                    throw CLI::ValidationError("--max-error", error.what());
                }
            },
            "Choose the fastest method whose RMS error stays below this share of full scale (0.005 or 0.5%). The error "
            "is measured on a small picture of the view, against the converged picture of the model that the options "
            "below select")
        ->type_name("SHARE")
        ->group("Accuracy and cost (steps from cheap to accurate)");
}

std::optional<ChosenSettings> apply_max_error(std::optional<double> max_error, edgesplat::Renderer& renderer,
                                              const edgesplat::Volume& volume, const edgesplat::Scene& scene,
                                              const edgesplat::Camera& camera, glm::ivec2 size,
                                              edgesplat::Settings& settings, bool quiet) {
    if (!max_error) return {};
    const ChosenSettings choice =
        edgesplat::accuracy::choose_settings(renderer, volume, scene, camera, size.x, size.y, {*max_error, settings});
    settings = choice.chosen.settings;
    if (!quiet)
        fmt::print(
            "--max-error {:.3g} %: {}; expected error {:.3g} % RMS; {:.1f} ms, default settings {:.1f} ms, at {}x{} "
            "pixels (ratio {:.2f})\n",
            100 * *max_error, difference_text(choice), 100 * choice.expected_error, choice.chosen.milliseconds,
            choice.default_milliseconds, choice.size.x, choice.size.y,
            choice.chosen.milliseconds / choice.default_milliseconds);
    return choice;
}

void add_error_estimate(const std::optional<ChosenSettings>& choice, std::optional<double> max_error,
                        edgesplat::ImageMetadata& metadata, nlohmann::ordered_json& json) {
    if (!choice) return;
    metadata.emplace_back("edgesplat:error", fmt::format("{:.3g} RMS of full scale expected, limit {:g}",
                                                         choice->expected_error, max_error.value_or(0)));
    json["error"] = {{"limit_rms", max_error.value_or(0)},      {"expected_rms", choice->expected_error},
                     {"measured_rms", choice->chosen.error},    {"reference_error", choice->reference_error},
                     {"chosen", difference_text(*choice)},      {"measured_at", {choice->size.x, choice->size.y}},
                     {"frame_ms", choice->chosen.milliseconds}, {"default_frame_ms", choice->default_milliseconds}};
}

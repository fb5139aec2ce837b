// The cheapest method that stays within an error, found by measuring on a small picture of the same view.
#pragma once

#include <string>
#include <vector>

#include "engine/renderer.h"

namespace edgesplat::accuracy {

struct ErrorLimit {
    double rms = 0.005;  ///< of the picture against the converged picture of its model, full scale = 1, (0, 1)
    Settings base;       ///< the model is the base's; method knobs are chosen
};

/// A method that was tried on the small picture.
struct TriedSettings {
    Settings settings;
    double error = 0;         ///< RMS on the small picture
    double milliseconds = 0;  ///< of a frame of the small picture, fastest of six; infinite where it was not timed
};

struct ChosenSettings {
    TriedSettings chosen;
    double expected_error = 0;         ///< of the picture: what was measured and a margin, at most the limit
    double reference_error = 0;        ///< worst pixel of what it was measured against
    double default_milliseconds = 0;   ///< a frame of the small picture with the base's own method
    glm::ivec2 size{0};                ///< of the small picture, pixels
    std::vector<TriedSettings> tried;  ///< cheapest first, those that are not good enough last
};

/// What is expected of a large picture is the small one's error times this (docs/accuracy_report.md says from what).
inline constexpr double kErrorMargin = 3;

/// The volume must be set in the renderer. Throws Error naming the best that can be had where nothing is good enough.
ChosenSettings choose_settings(Renderer& renderer, const Volume& volume, const Scene& scene, const Camera& camera,
                               int width, int height, const ErrorLimit& limit);

/// "0.5%" or "0.005" as a share; throws Error unless it is above 0 and below 1.
double error_share(std::string_view text);

}  // namespace edgesplat::accuracy

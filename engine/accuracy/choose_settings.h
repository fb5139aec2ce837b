// Finds the cheapest method within an error limit, by measuring a small picture of the same view.
#pragma once

#include <string>
#include <vector>

#include "engine/renderer.h"

namespace edgesplat::accuracy {

struct ErrorLimit {
    double rms = 0.005;  ///< upper bound of the error against the model's converged picture, full scale = 1, (0, 1)
    Settings base;       ///< its model is kept; its method knobs are chosen
};

/// A method that was tried on the small picture.
struct TriedSettings {
    Settings settings;
    double error = 0;         ///< RMS on the small picture
    double milliseconds = 0;  ///< per frame of the small picture, fastest of six; infinite: not timed
};

struct ChosenSettings {
    TriedSettings chosen;
    double expected_error = 0;         ///< of the picture: measured error times kErrorMargin, at most the limit
    double reference_error = 0;        ///< worst pixel of the reference
    double default_milliseconds = 0;   ///< per frame of the small picture with the base's own method
    glm::ivec2 size{0};                ///< of the small picture, pixels
    std::vector<TriedSettings> tried;  ///< cheapest first; those that were not timed come last
};

/// Expected error of the large picture / error of the small one (docs/accuracy_report.md gives the reason).
inline constexpr double kErrorMargin = 3;

/// The volume must be set in the renderer. Throws Error, which names the best method, if none is good enough.
ChosenSettings choose_settings(Renderer& renderer, const Volume& volume, const Scene& scene, const Camera& camera,
                               int width, int height, const ErrorLimit& limit);

/// "0.5%" or "0.005" as a share; throws Error unless it is above 0 and below 1.
double error_share(std::string_view text);

}  // namespace edgesplat::accuracy

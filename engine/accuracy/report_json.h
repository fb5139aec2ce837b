// Converts results of the accuracy report to JSON: single measurements for the journal, and the whole for report.json
// (docs/accuracy_report.md).
#pragma once

#include <nlohmann/json.hpp>

#include "engine/accuracy/report.h"

namespace edgesplat::accuracy {

nlohmann::ordered_json to_json(const ImageError& error);
nlohmann::ordered_json to_json(const EdgeFigures& figures);
nlohmann::ordered_json to_json(const Popping& popping);
nlohmann::ordered_json to_json(const Spread& spread);
nlohmann::ordered_json settings_json(const Settings& settings);  ///< every knob under its name, with underscores

// Read these again. They throw nlohmann's exceptions if something is missing.
ImageError image_error_from(const nlohmann::ordered_json& json);
EdgeFigures edge_figures_from(const nlohmann::ordered_json& json);
Popping popping_from(const nlohmann::ordered_json& json);

/// The whole report. Values that differ between two runs, the times, are only under "time" and "raycast_ms".
nlohmann::ordered_json report_json(const Report& report);

}  // namespace edgesplat::accuracy

// The report as text: steps.csv for other programs, a short table for the terminal.
#pragma once

#include <string>

#include "engine/accuracy/report.h"

namespace edgesplat::accuracy {

/// One line per row, the first names the columns; full precision, a point as decimal sign, empty where nothing is
/// known.
std::string steps_csv(const Report& report);

/// Steps by knob and the presets, in columns.
std::string steps_table(const Report& report);

}  // namespace edgesplat::accuracy

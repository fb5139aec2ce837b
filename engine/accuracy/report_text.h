// Makes texts of the report: steps.csv for other programs, and a short table for the terminal.
#pragma once

#include <string>

#include "engine/accuracy/report.h"

namespace edgesplat::accuracy {

/// One line per row; the first line names the columns. Full precision, decimal point, empty cells for unknown values.
std::string steps_csv(const Report& report);

/// A table of the steps by knob and of the presets.
std::string steps_table(const Report& report);

}  // namespace edgesplat::accuracy

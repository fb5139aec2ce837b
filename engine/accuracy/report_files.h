// Writes the files of a report.
#pragma once

#include <filesystem>

#include "engine/accuracy/measure.h"

namespace edgesplat::accuracy {

/// Checks before a measurement that the folder can be created and written. Throws Error.
void check_report_folder(const std::filesystem::path& folder);

/// Writes index.html, report.json and steps.csv into the report's folder, all or none. Throws Error.
void write_report(const Measured& measured);

}  // namespace edgesplat::accuracy

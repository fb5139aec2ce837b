// The files of a report.
#pragma once

#include <filesystem>

#include "engine/accuracy/measure.h"

namespace edgesplat::accuracy {

/// Refuses, before anything is measured, a folder that could not be made or written. Throws Error.
void check_report_folder(const std::filesystem::path& folder);

/// Writes index.html, report.json and steps.csv into the report's folder; all of them or none. Throws Error.
void write_report(const Measured& measured);

}  // namespace edgesplat::accuracy

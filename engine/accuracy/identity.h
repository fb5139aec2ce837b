// What tells one measurement from another.
#pragma once

#include <nlohmann/json.hpp>

#include "engine/accuracy/report.h"

namespace edgesplat::accuracy {

/// What must be the same for the journal of an earlier run to be of use.
nlohmann::ordered_json identity_of(const ReportInput& input, const ReportOptions& options, const DeviceInfo& device);

}  // namespace edgesplat::accuracy

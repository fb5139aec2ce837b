// The identity of a measurement.
#pragma once

#include <nlohmann/json.hpp>

#include "engine/accuracy/report.h"

namespace edgesplat::accuracy {

/// All inputs that must be equal for the journal of an earlier run to be usable.
nlohmann::ordered_json identity_of(const ReportInput& input, const ReportOptions& options, const DeviceInfo& device);

}  // namespace edgesplat::accuracy

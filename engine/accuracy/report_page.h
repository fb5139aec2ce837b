// Makes the report page: one self-contained file, without network or scripts.
#pragma once

#include <string>

#include "engine/accuracy/measure.h"

namespace edgesplat::accuracy {

/// The HTML page, with plots as inline SVG and pictures as embedded data.
std::string report_page(const Measured& measured);

}  // namespace edgesplat::accuracy

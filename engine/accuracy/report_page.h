// The report as one page that needs nothing else: no network, no scripts.
#pragma once

#include <string>

#include "engine/accuracy/measure.h"

namespace edgesplat::accuracy {

/// HTML with plots as inline SVG and pictures as data.
std::string report_page(const Measured& measured);

}  // namespace edgesplat::accuracy

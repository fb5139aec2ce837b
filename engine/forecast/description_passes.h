// The passes of a forecast: order, pipeline variants, and what they will about take.
#pragma once

#include "engine/forecast/description.h"
#include "engine/forecast/forecast.h"

namespace edgesplat {

/// Without reasons. `software`: times of a device that is the machine's processor.
std::vector<PassDescription> described_passes(const FrameRequest& request, const FrameForecast& forecast,
                                              bool software);

/// What the times are based on, a sentence.
std::string estimate_basis(bool software);

}  // namespace edgesplat

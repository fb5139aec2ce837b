// The passes of a forecast: order, pipeline variants, and what they will about take.
#pragma once

#include "engine/forecast/description.h"
#include "engine/forecast/forecast.h"

namespace edgesplat {

/// Without reasons. Times of that device; null: of one that is the machine's processor.
std::vector<PassDescription> described_passes(const FrameRequest& request, const FrameForecast& forecast,
                                              const DeviceInfo* device);

/// What the times are based on, a sentence.
std::string estimate_basis(const DeviceInfo* device);

}  // namespace edgesplat

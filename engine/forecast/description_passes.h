// Lists the passes of a forecast: order and pipeline variants.
#pragma once

#include "engine/forecast/description.h"
#include "engine/forecast/forecast.h"

namespace edgesplat {

/// The passes, reasons unset.
std::vector<PassDescription> described_passes(const FrameRequest& request, const FrameForecast& forecast);

/// Pipelines that the picture will use, in order of use. Whether pixels are refined is a guess.
std::vector<gpu::PipelineVariant> pipelines_of(const FrameRequest& request, FrameForecast forecast);

}  // namespace edgesplat

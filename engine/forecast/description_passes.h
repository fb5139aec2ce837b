// Lists the passes of a forecast: order, pipeline variants and estimated times.
#pragma once

#include "engine/forecast/description.h"
#include "engine/forecast/forecast.h"

namespace edgesplat {

/// The passes, reasons unset. Times are for `device`; null: a software device on the processor.
std::vector<PassDescription> described_passes(const FrameRequest& request, const FrameForecast& forecast,
                                              const DeviceInfo* device);

/// Pipelines that the picture will use, in order of use. Whether pixels are refined is a guess.
std::vector<gpu::PipelineVariant> pipelines_of(const FrameRequest& request, FrameForecast forecast);

/// Basis of the estimated times, a sentence.
std::string estimate_basis(const DeviceInfo* device);

}  // namespace edgesplat

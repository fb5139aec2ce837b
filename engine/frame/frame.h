// The frame on one page: which pass runs when, on what.
#pragma once

#include "engine/plan/plan.h"
#include "engine/plan/resources.h"
#include "engine/store/collection.h"

namespace edgesplat {

/// Adds times to those of the same name.
void add_times(std::vector<PassTime>& sums, const std::vector<PassTime>& times);

/// View-dependent: splat list -> pixels in `targets.output`. Runs and waits.
void run_frame(gpu::Commands& commands, const FramePlan& plan, const TargetResources& targets);

}  // namespace edgesplat

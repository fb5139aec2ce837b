// The frame on one page: which pass runs when, on what.
#pragma once

#include "engine/frame_plan.h"
#include "engine/frame_resources.h"
#include "engine/passes/2_collect_splats.h"

namespace edgesplat {

/// What pass 2 is given.
passes::CollectSplats collect_inputs(const CollectionPlan& plan);

/// View-independent: volume -> splat list. Allocates what the plan calls for in `resources`, which holds the uploaded
/// volume (and coefficients), and fills `splats`, `splat_count` and the box. Runs, waits, and returns
/// what each pass took.
std::vector<PassTime> run_collection(const gpu::Device& device, gpu::Commands& commands, const Bindings& bindings,
                                     const CollectionPlan& plan, VolumeResources& resources);

/// Adds times to those of the same name.
void add_times(std::vector<PassTime>& sums, const std::vector<PassTime>& times);

/// View-dependent: splat list -> pixels in `targets.output`. Runs and waits.
void run_frame(gpu::Commands& commands, const FramePlan& plan, const TargetResources& targets);

}  // namespace edgesplat

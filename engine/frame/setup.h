// What a picture needs that no camera changes: passes 1 to 2d.
#pragma once

#include "engine/frame/targets.h"
#include "engine/store/splat_store.h"

namespace edgesplat {

/// Of a volume that the level holds as a whole: its splats, and what the scene calls for of their light, each if it
/// differs from what is there. Milliseconds spent, 0 where nothing did.
double set_up(DeviceSession& session, LevelStore& level, Targets& targets, const Scene& scene, const Settings& settings,
              bool keep_buried, SetupCost& cost);

/// Passes 2c and 2d, if the scene calls for them and what was found differs; the targets are dropped then. Whether they
/// ran.
bool cast_shadows(DeviceSession& session, LevelStore& level, Targets& targets, const Scene& scene,
                  const Settings& settings, SetupCost& cost);

}  // namespace edgesplat

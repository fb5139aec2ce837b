// Splat list and volume -> share of a light that reaches each splat.
#pragma once

#include "engine/gpu/commands.h"
#include "engine/passes/2b_occlude_ambient.h"

namespace edgesplat::passes {

/// Reads the volume, SceneParams and the splat list, writes half LightParams::channel of LightParams::reach with the
/// share of LightParams::light. View-independent. Specialized like 2b_occlude_ambient.comp.
gpu::Pass cast_shadows(const SplatLight& in);

}  // namespace edgesplat::passes

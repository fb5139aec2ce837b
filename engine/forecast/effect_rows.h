// The rows of the table of effects, grouped by the part of a request that enables them. Only effect_table.cpp needs it.
#pragma once

#include "engine/forecast/effect_table.h"

namespace edgesplat {

std::vector<Effect> settings_effects();  ///< settings
std::vector<Effect> light_effects();     ///< light, response, fog, silhouettes, transfer functions
std::vector<Effect> view_effects();      ///< clip, sampling, background, overlays
std::vector<Effect> output_effects();    ///< extra outputs

/// Sets `march` edges, procedural footprints and kernels cut at faces.
void cut_at_faces(FrameRequest& request);

/// Makes the highest material opaque: it occludes everything a few voxels behind its surface.
void make_opaque(FrameRequest& request);

}  // namespace edgesplat

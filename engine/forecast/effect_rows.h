// The rows of the table of effects, by what calls for them. Only effect_table.cpp needs this.
#pragma once

#include "engine/forecast/effect_table.h"

namespace edgesplat {

std::vector<Effect> settings_effects();  ///< knobs of the ladder
std::vector<Effect> light_effects();     ///< light, response, fog, silhouettes, transfer functions
std::vector<Effect> view_effects();      ///< clip, sampling, background, overlays
std::vector<Effect> output_effects();    ///< extra outputs

/// Faces by the march, kernels integrated.
void cut_at_faces(FrameRequest& request);

/// The highest material so opaque that it hides what lies a few voxels behind its surface.
void make_opaque(FrameRequest& request);

}  // namespace edgesplat

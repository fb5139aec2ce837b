// The parameters of a picture, `params.frame`, and of the volume whose splat is processed, `params.of_volume`. Splats of
// several volumes are processed alike only if their kernels are drawn as one list: the list has a number for each splat,
// and enter_volume() finds its volume.
#ifndef EDGESPLAT_FRAME_GLSL
#define EDGESPLAT_FRAME_GLSL
#include "shaders/shared/bindings.h"
#include "shaders/shared/frame_params.h"

layout(constant_id = SPEC_TOGETHER) const uint TOGETHER = 0u;
layout(binding = BIND_FRAME, scalar) uniform Frame {
    FrameParams frame;
    VolumeParams volumes[MAX_TOGETHER];
} params;

uint volume_number = 0u;
#define of_volume volumes[TOGETHER == 1u ? volume_number : 0u]

// Selects the volume of a splat of the list. Returns the splat's number in its volume's own list.
uint enter_volume(uint number) {
    if (TOGETHER == 0u) return number;
    volume_number = 0u;
    for (uint k = 1u; k < MAX_TOGETHER; ++k) volume_number += k < params.frame.volume_count && number >= params.volumes[k].first_splat ? 1u : 0u;
    return number - params.of_volume.first_splat;
}

// A splat's number in the list, from that in its volume's own list.
uint number_in_list(uint number) { return TOGETHER == 1u ? number + params.of_volume.first_splat : number; }
#endif

// The matter in the field that surface splats show. Include after the uniform block `params.frame`.
#ifndef EDGESPLAT_MATTER_GLSL
#define EDGESPLAT_MATTER_GLSL
#define ISO_VALUES params.of_volume.iso
#include "shaders/common/material.glsl"

bool is_drawn(uint material) { return in_mask(params.of_volume.visible_mask, material); }

// The values of the body of matter that contains a value, half open: materials with matter that adjoin are one body.
vec2 body_around(float value) {
    vec2 body = vec2(-3e38, 3e38);
    for (uint j = 0u; j < ISO_COUNT; ++j) {
        float iso = params.of_volume.iso[j];
        bool ends = is_drawn(j) != is_drawn(j + 1u);
        body.x = ends && iso <= value ? iso : body.x;
        body.y = ends && iso > value ? min(body.y, iso) : body.y;
    }
    return body;
}
#endif

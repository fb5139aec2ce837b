// The material of a value of the field. Include after the uniform block `params.frame`.
#ifndef EDGESPLAT_MATTER_GLSL
#define EDGESPLAT_MATTER_GLSL
layout(constant_id = SPEC_ISO_COUNT) const uint ISO_COUNT = 1u;

uint material_of(float value) {
    uint material = 0u;
    for (uint j = 0u; j < ISO_COUNT; ++j) material += params.frame.iso[j] <= value ? 1u : 0u;
    return material;
}

bool is_drawn(uint material) { return (params.frame.visible_mask >> material & 1u) == 1u; }

// The values of the body of matter that contains a value, half open: materials with matter that adjoin are one body.
vec2 body_around(float value) {
    vec2 body = vec2(-3e38, 3e38);
    for (uint j = 0u; j < ISO_COUNT; ++j) {
        float iso = params.frame.iso[j];
        bool ends = is_drawn(j) != is_drawn(j + 1u);
        body.x = ends && iso <= value ? iso : body.x;
        body.y = ends && iso > value ? min(body.y, iso) : body.y;
    }
    return body;
}
#endif

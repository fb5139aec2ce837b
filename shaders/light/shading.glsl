// The colour of a splat as seen from the eye: lighting, silhouette and fog. docs/method.md, Shading. The including
// shader declares the uniform block `params.frame`.
#ifndef EDGESPLAT_SHADING_GLSL
#define EDGESPLAT_SHADING_GLSL
#include "shaders/shared/frame_params.h"
#include "shaders/light/occlusion.glsl"
#include "shaders/light/shadow.glsl"

layout(constant_id = SPEC_LIGHT) const uint LIGHTS = 1u;
layout(constant_id = SPEC_RESPONSE) const uint RESPONSE = 0u;
layout(constant_id = SPEC_GLOSS) const uint GLOSS = 0u;
layout(constant_id = SPEC_FOG) const uint FOG = 0u;
layout(constant_id = SPEC_SILHOUETTE) const uint SILHOUETTE = 0u;

// How a material responds to light.
vec4 response_of(uint material) {
    if (RESPONSE == 1u) return params.of_volume.responses[material];
    return vec4(1.0, 1.0, 0.0, 1.0);
}

// What engine/geometry/shading.glsl asks for.
#define LightShares vec2
float light_share(vec2 shares, uint light) { return light_reach(shares, light); }
vec4 light_place(uint light) { return params.frame.light_at[light]; }
vec3 light_sent(uint light) { return params.frame.light_color[light].rgb; }
float ambient_light() { return params.frame.ambient; }
// The whole vector: lavapipe reads its last component alone incorrectly.
vec4 silhouette_color() { return params.frame.silhouette; }
float silhouette_sharpness() { return params.frame.silhouette_sharpness; }
vec4 fog_color() { return params.frame.fog; }
float fog_start() { return params.frame.fog_start; }
#include "footprints/in_float.glsl"
#include "engine/geometry/shading.glsl"
#endif

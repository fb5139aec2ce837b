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

struct Surface {
    vec3 color;       // linear light
    uint material;
    vec2 lights;      // shares of the two lights with shadows that arrive (lights_reach)
    bool has_normal;
    vec3 normal;      // world, unit
    float ambient;    // share of ambient light that arrives (ambient_reach)
    vec3 from_eye;    // world, mm
    vec3 to_eye;      // world, unit
    float depth;      // along the view axis, mm
};

// pow(0, x) is not defined on every device.
float power(float base, float exponent) { return base > 0.0 ? pow(base, exponent) : 0.0; }

vec3 unit_or_zero(vec3 v) { return dot(v, v) > 0.0 ? normalize(v) : vec3(0.0); }

// Blinn 1977, "Models of light reflection for computer synthesized pictures".
vec3 lit(Surface s) {
    vec4 response = RESPONSE == 1u ? params.frame.responses[s.material] : vec4(1.0, 1.0, 0.0, 1.0);
    vec3 diffuse = vec3(params.frame.ambient * response.x * s.ambient);
    vec3 specular = vec3(0.0);
    for (uint l = 0u; l < LIGHTS; ++l) {
        vec4 place = params.frame.light_at[l];
        vec3 towards = place.xyz - place.w * s.from_eye;
        // At the light itself, all directions are equivalent.
        bool at_light = dot(towards, towards) == 0.0;
        vec3 to_light = unit_or_zero(towards);
        float facing = at_light ? 1.0 : dot(s.normal, to_light);
        vec3 light = params.frame.light_color[l].rgb * light_reach(s.lights, l);
        diffuse += response.y * light * (s.has_normal ? max(facing, 0.0) : 0.5);
        if (GLOSS == 1u) {
            vec3 halfway = unit_or_zero(to_light + s.to_eye);
            float glossy = response.z * power(dot(s.normal, halfway), response.w);
            specular += s.has_normal && facing > 0.0 ? light * glossy : vec3(0.0);
        }
    }
    if (GLOSS == 0u) return s.color * diffuse;
    return s.color * diffuse + specular;
}

vec3 shade(Surface s) {
    vec3 color = s.color;
    if (LIGHTS > 0u) color = lit(s);
    if (SILHOUETTE == 1u) {
        // Loads the whole vector: lavapipe reads its last component alone incorrectly.
        vec4 outline = params.frame.silhouette;
        float turned = power(1.0 - abs(dot(s.normal, s.to_eye)), params.frame.silhouette_sharpness);
        float share = s.has_normal ? outline.a * turned : 0.0;
        color += share * (outline.rgb - color);
    }
    if (FOG == 1u) {
        vec4 fog = params.frame.fog;
        float clear = exp(-fog.a * max(s.depth - params.frame.fog_start, 0.0));
        color = mix(fog.rgb, color, clear);
    }
    return color;
}
#endif

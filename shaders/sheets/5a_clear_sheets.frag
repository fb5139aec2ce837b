// Clears a sheet group. Saturated pixels get depth 0, which rejects their fragments before shading.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bindings.h"
#include "shaders/shared/frame_params.h"

layout(binding = BIND_ACCUMULATED) uniform sampler2D accumulated;
#include "shaders/common/frame.glsl"
layout(push_constant) uniform Push { uint group; };
layout(location = 0) out vec4 sheet;

void main() {
    sheet = vec4(0.0);
    gl_FragDepth = texelFetch(accumulated, ivec2(gl_FragCoord.xy), 0).a >= params.frame.saturation ? 0.0 : 1.0;
}

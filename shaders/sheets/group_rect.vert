// A quad over the pixels that a sheet group touches, in layer gl_InstanceIndex, so that only these are cleared and
// composited.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_ARB_shader_viewport_layer_array : require
#include "shaders/shared/bindings.h"
#include "shaders/shared/frame_params.h"

#include "shaders/common/frame.glsl"
layout(push_constant) uniform Push { uint group; };

void main() {
    ivec4 rect = GroupsRef(params.frame.groups).at[group].rect;
    rect.zw = max(rect.zw, rect.xy);
    vec2 corner = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1);
    vec2 pixel = mix(vec2(rect.xy), vec2(rect.zw), corner);
    gl_Position = vec4(pixel / vec2(params.frame.size) * 2.0 - 1.0, 0.0, 1.0);
    gl_Layer = gl_InstanceIndex;
}

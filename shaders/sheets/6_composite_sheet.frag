// Composites a group's sheets front to back. The blend state puts the result behind the accumulated sheets.
// docs/method.md, pass 6; design (10).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bindings.h"
#include "shaders/shared/frame_params.h"

layout(constant_id = SPEC_PAYLOAD) const uint PAYLOAD = 0u;
layout(binding = BIND_SHEETS) uniform sampler2DArray sheets;
#include "shaders/common/frame.glsl"
layout(push_constant) uniform Push { uint group; };
layout(location = 0) out vec4 accumulated;

#include "shaders/common/fold_sheet.glsl"

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    int count = int(min(params.frame.sheets_per_group, params.frame.sheet_count - group * params.frame.sheets_per_group));
    vec4 sum = vec4(0.0);
    for (int i = 0; i < count; ++i) sum = folded(sum, texelFetch(sheets, ivec3(pixel, i), 0));
    accumulated = sum;
}

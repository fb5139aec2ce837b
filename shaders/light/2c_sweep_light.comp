// For one sheet group of the light's picture: the optical depth from the light to the far plane of each sheet.
// docs/method.md, 2c_sweep_light.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bindings.h"
#include "shaders/shared/frame_params.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = BIND_SHEETS) uniform sampler2DArray sheets;
layout(binding = BIND_ACCUMULATED) uniform sampler2D accumulated;
layout(binding = BIND_FRAME, scalar) uniform Frame { FrameParams frame; } params;
layout(push_constant) uniform Push { uint group; };

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = params.frame.size;
    bool inside = all(lessThan(pixel, size));
    ivec4 rect = GroupsRef(params.frame.groups).at[group].rect;
    bool touched = all(greaterThanEqual(pixel, rect.xy)) && all(lessThan(pixel, rect.zw));
    int first = int(group * params.frame.sheets_per_group);
    // The loop bound varies per pixel: lavapipe recompiles and stores a shader for loops that a uniform bounds.
    int count = inside ? min(int(params.frame.sheets_per_group), int(params.frame.sheet_count) - first) : 0;
    float tau = texelFetch(accumulated, pixel, 0).a;
    for (int i = 0; i < count; ++i) {
        // Outside the group's rectangle its sheets were not cleared: they contain old data.
        float sheet = texelFetch(sheets, ivec3(pixel, i), 0).a;
        tau += touched ? sheet : 0.0;
        FloatsRef(params.frame.light_layers).at[((first + i) * size.y + pixel.y) * size.x + pixel.x] = tau;
    }
}

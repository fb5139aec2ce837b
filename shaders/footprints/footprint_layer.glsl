// Selects the table layers that a footprint is blended from: the float32 mirror of footprints/footprint_table.h (same
// names, same equations). Include after shaders/footprints/kernel.glsl. Written in the subset of GLSL that is also C++.
#ifndef EDGESPLAT_FOOTPRINT_LAYER_GLSL
#define EDGESPLAT_FOOTPRINT_LAYER_GLSL
#include "shaders/shared/footprint_table.h"

struct FootprintLayer {
    uint code;
    float middle;
    float cosine;
    float rim2;
};

const uint TABLE_MASK = (1u << TABLE_BLEND_BITS) - 1u;

float table_blend(uint code, uint bits) { return float((code >> bits) & TABLE_MASK) * (1.0 / TABLE_BLEND_STEPS); }

// Sine and cosine of an angle from the tangent of its half, and that tangent from the sine.
float half_sine(float tangent) { return 2.0 * tangent / (1.0 + tangent * tangent); }
float half_cosine(float tangent) { return (1.0 - tangent * tangent) / (1.0 + tangent * tangent); }
float half_tangent(float sine) { return sine / (1.0 + sqrt(max(1.0 - sine * sine, 0.0))); }

FootprintLayer decode_footprint_layer(uint code, float depth) {
    uint layer = code & TABLE_MASK;
    float to_next = float(layer / TABLE_DIRECTIONS) + table_blend(code, TABLE_BLEND_BITS);
    float turned = float(layer % TABLE_DIRECTIONS) + table_blend(code, 2u * TABLE_BLEND_BITS);
    float of_distance = 2.0 * to_next / float(TABLE_DISTANCES - 1u) - 1.0;
    float of_direction = turned / float(TABLE_DIRECTIONS - 1u);
    float rim = KERNEL_R * half_cosine(of_distance);
    FootprintLayer l;
    l.code = code;
    l.middle = (KERNEL_R * half_sine(of_distance) + depth) * half_cosine(of_direction);
    l.cosine = half_sine(of_direction);
    l.rim2 = rim * rim;
    return l;
}

uint select_footprint_layer(float distance, float cosine, float depth) {
    float e = clamp((distance - depth) / KERNEL_R, -1.0, 1.0);
    float i = (half_tangent(e) + 1.0) * 0.5 * float(TABLE_DISTANCES - 1u);
    float j = half_tangent(clamp(cosine, 0.0, 1.0)) * float(TABLE_DIRECTIONS - 1u);
    float i0 = clamp(floor(i), 0.0, float(TABLE_DISTANCES - 2u));
    float j0 = clamp(floor(j), 0.0, float(TABLE_DIRECTIONS - 2u));
    uint to_next = uint(clamp(i - i0, 0.0, 1.0) * TABLE_BLEND_STEPS + 0.5);
    uint turned = uint(clamp(j - j0, 0.0, 1.0) * TABLE_BLEND_STEPS + 0.5);
    return (uint(i0) * TABLE_DIRECTIONS + uint(j0)) | (to_next << TABLE_BLEND_BITS) | (turned << (2u * TABLE_BLEND_BITS));
}
#endif

// The table's layers in float. Include after shaders/footprints/kernel.glsl. Written in the subset of GLSL that is also C++.
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

#include "footprints/table_layer.glsl"
#endif

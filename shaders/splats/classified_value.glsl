// Two-sided classification: what a voxel at an edge holds is told by the value a voxel further on its own side.
// docs/method.md, Transfer functions. The including shader includes common/trilinear.glsl, common/material.glsl and
// edges/edge_record.glsl.
#include "shaders/drivers/if_any.glsl"

float classified_value(ivec3 p, float own, uint material, Edge e) {
    float value = own, way = max(1.0, 1.0 - e.d);
    bool mixed = e.state >= EDGE_LOWER && abs(e.d) < 1.0 && way < e.d2;
    IF_ANY(mixed) {
        float further = trilinear(p, -way * e.n);
        value = material_of(further) == material ? further : own;
    }
    return value;
}

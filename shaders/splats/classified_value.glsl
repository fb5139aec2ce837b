// Two-sided classification: what a voxel at an edge holds is told by the value a voxel further on its own side.
// docs/method.md, Transfer functions. The including shader includes lib/trilinear.glsl, lib/material.glsl and
// lib/edge_record.glsl.
float classified_value(ivec3 p, float own, uint material, Edge e) {
    float value = own, way = max(1.0, 1.0 - e.d);
    bool mixed = e.state >= EDGE_LOWER && abs(e.d) < 1.0 && way < e.d2;
    for (int run = mixed ? 1 : 0; run > 0; --run) {
        float further = trilinear(p, -way * e.n);
        value = material_of(further) == material ? further : own;
    }
    return value;
}

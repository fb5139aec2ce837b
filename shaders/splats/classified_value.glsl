// Two-sided classification: a voxel at an edge takes the value at a point further inside its own material.
// docs/method.md, Transfer functions. The including shader includes common/trilinear.glsl, common/material.glsl and
// edges/edge_record.glsl.
#include "shaders/drivers/if_any.glsl"
#include "shaders/edges/values_around.glsl"

float classified_value(ivec3 p, float own, uint material, Edge e) {
    float value = own, way = max(1.0, 1.0 - e.d);
    bool mixed = e.state >= EDGE_LOWER && abs(e.d) < 1.0;
    IF_ANY(mixed) {
        float further = trilinear(p, -way * e.n);
        value = material_of(further) == material ? further : own;
    }
    return value;
}

// The value of a voxel beside matter of another material, for that material: the value 1 voxel behind the edge. If that
// is not in the material's interval: the middle of the interval, or the extreme sample around for an outermost
// interval.
float carried_value(ivec3 p, uint own, uint material, Edge e) {
    bool outermost = material == 0u || material == ISO_COUNT;
    float value = 0.0;
    if (!outermost) value = 0.5 * (params.scene.iso[material - 1u] + params.scene.iso[material]);
    IF_ANY(outermost) {
        vec2 around = values_around(p);
        value = material == 0u ? around.x : outermost ? around.y : value;
        bool missing = material == 0u && !has_data(around.x);
        IF_ANY(missing) value = missing ? least_data_around(p) : value;
    }
    bool ahead = e.state >= EDGE_LOWER && (e.state == EDGE_UPPER) == (material > own);
    IF_ANY(ahead) {
        float further = trilinear(p, (e.d + 1.0) * e.n);
        value = ahead && material_of(further) == material ? further : value;
    }
    return value;
}

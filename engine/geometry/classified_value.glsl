// Two-sided classification: a voxel at an edge takes the value at a point further inside its own material.
// docs/method/2_collect_splats.md. Written in the subset of GLSL that is C++. The includer declares trilinear(ivec3, vec3),
// material_of(Real), lower_end(material), upper_end(material) and ISO_COUNT, the number of iso-values. Include after edge.glsl
// and values_around.glsl.

Real classified_value(ivec3 p, Real own, uint material, Edge e) {
    Real value = own;
    Real way = max(1.0, 1.0 - e.d);
    bool mixed = e.state >= EDGE_LOWER && abs(e.d) < 1.0;
    IF_ANY(mixed) {
        Real further = trilinear(p, -way * e.n);
        value = material_of(further) == material ? further : own;
    }
    return value;
}

// The value of a voxel beside matter of another material, for that material: the value 1 voxel behind the edge. If that
// is not in the material's interval: the middle of the interval, or the extreme sample around for an outermost
// interval.
Real carried_value(ivec3 p, uint own, uint material, Edge e) {
    bool outermost = material == 0u || material == ISO_COUNT;
    Real value = 0.0;
    if (!outermost) value = 0.5 * (lower_end(material) + upper_end(material));
    IF_ANY(outermost) {
        vec2 around = values_around(p);
        value = material == 0u ? around.x : outermost ? around.y : value;
        bool missing = material == 0u && !has_data(around.x);
        IF_ANY(missing) value = missing ? least_data_around(p) : value;
    }
    bool ahead = e.state >= EDGE_LOWER && (e.state == EDGE_UPPER) == (material > own);
    IF_ANY(ahead) {
        Real further = trilinear(p, (e.d + 1.0) * e.n);
        value = ahead && material_of(further) == material ? further : value;
    }
    return value;
}

// The weight of a kernel by its distance to the edge: what one side of an edge draws then reaches up to it.
// docs/method.md, pass 2. The including shader declares the uniform block `params.scene` and includes lib/edge_record.glsl.
float weight_at(float distance) {
    float at = clamp(distance, 0.0, EDGE_WEIGHT_REACH) * (float(EDGE_WEIGHT_STEPS) / EDGE_WEIGHT_REACH);
    uint cell = min(uint(at), EDGE_WEIGHT_STEPS - 1u);
    return mix(params.scene.edge_weights[cell], params.scene.edge_weights[cell + 1u], at - float(cell));
}

// Where the other side is drawn as densely nothing is weighted: the two sides sum to one as they are.
float edge_weight(Edge e, float contrast) {
    float weight = weight_at(e.d);
    if (e.d2 < params.scene.band) weight = mix(1.0, weight * weight_at(e.d2), clamp(2.0 * (e.d + e.d2) - 5.0, 0.0, 1.0));
    return e.state >= EDGE_LOWER ? 1.0 + contrast * (weight - 1.0) : 1.0;
}

// The material of a sample: the number of iso-values it reaches. The including shader declares the uniform block `params.scene`.
uint material_of(float value) {
    uint material = 0u;
    for (uint j = 0u; j < params.scene.iso_count; ++j) material += params.scene.iso[j] <= value ? 1u : 0u;
    return material;
}

bool in_mask(uint mask, uint material) { return (mask >> material & 1u) == 1u; }

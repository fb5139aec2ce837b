// The material of a sample: the number of iso-values it reaches. The including shader declares the uniform block
// `params.scene`. Their number is a constant: lavapipe compiles a shader anew, and keeps what it compiled, each time one
// is bound whose loops end where a uniform says.
layout(constant_id = SPEC_ISO_COUNT) const uint ISO_COUNT = 1u;

uint material_of(float value) {
    uint material = 0u;
    for (uint j = 0u; j < ISO_COUNT; ++j) material += params.scene.iso[j] <= value ? 1u : 0u;
    return material;
}

bool in_mask(uint mask, uint material) { return (mask >> material & 1u) == 1u; }

// The material of a sample: the number of iso-values that are at most the sample. The including shader declares the
// uniform block `params.scene`, or defines ISO_VALUES. ISO_COUNT is a constant because of lavapipe: it recompiles a
// shader at each bind, and keeps every compiled version, if a uniform bounds one of its loops.
#ifndef ISO_VALUES
#define ISO_VALUES params.scene.iso
#endif
layout(constant_id = SPEC_ISO_COUNT) const uint ISO_COUNT = 1u;

uint material_of(float value) {
    uint material = 0u;
    for (uint j = 0u; j < ISO_COUNT; ++j) material += ISO_VALUES[j] <= value ? 1u : 0u;
    return material;
}

// The ends of a material's interval; the lowest material has no lower one.
float lower_end(uint material) { return ISO_VALUES[material - 1u]; }
float upper_end(uint material) { return ISO_VALUES[material]; }

bool in_mask(uint mask, uint material) { return (mask >> material & 1u) == 1u; }

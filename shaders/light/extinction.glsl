// Extinction of the volume's matter for light. The including shader declares `volume`, `params.scene`, LightParams as
// `light.at`, TRANSFER, CLIP_KEEP and CLIP_REMOVE.
#define ISO_VALUES light.at.iso
#include "shaders/common/transfer.glsl"
#include "shaders/common/material.glsl"
#include "shaders/common/clip.glsl"

const float DARK = 12.0;  // optical depth; from here on, transmittance rounds to 0 in 16 bits

// Of matter with this value at p, index space, per mm; 0 without data and where matter is clipped away.
float extinction_of(float value, vec3 p) {
    float extinction = TRANSFER == 1u ? transfer_at(TransferRef(params.scene.transfer), value).a : light.at.extinction[material_of(value)];
    extinction = value >= 0.0 ? extinction : 0.0;
    if (CLIP_KEEP + CLIP_REMOVE > 0u) extinction = is_cut_away(p, 0.0) ? 0.0 : extinction;
    return extinction;
}

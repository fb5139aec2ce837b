// Extinction for light of a volume's matter: of the splats' own volume, or with BESIDE of another one. The including
// shader declares `volume` (of the matter), `params.scene` (of the splats), LightParams as `light.at`, BESIDE, TRANSFER,
// CLIP_KEEP and CLIP_REMOVE.
#define ISO_VALUES light.at.iso
#include "shaders/common/transfer.glsl"
#include "shaders/common/material.glsl"
#include "shaders/common/clip.glsl"

const float DARK = 12.0;  // optical depth; from here on, transmittance rounds to 0 in 16 bits

// From the splats' index space to that of the matter.
vec3 in_matter(vec3 p) { return BESIDE == 1u ? light.at.to_matter * p + light.at.matter_at : p; }

ivec3 matter_dims() { return BESIDE == 1u ? light.at.matter_dims : params.scene.dims; }

// World directions to the matter's index space.
mat3 world_to_matter() { return transpose(BESIDE == 1u ? light.at.matter_normals : light.at.normal_to_world); }

bool planes_cut_splats() { return CLIP_KEEP + CLIP_REMOVE > 0u && (BESIDE == 0u || light.at.cuts_splats == 1u); }

// Of matter with this value at p, the matter's index space, per mm; 0 without data and where matter is clipped away.
float extinction_of(float value, vec3 p) {
    float extinction = 0.0;
    if (TRANSFER == 1u) extinction = transfer_at(TransferRef(BESIDE == 1u ? light.at.matter_transfer : params.scene.transfer), value).a;
    else extinction = light.at.extinction[material_of(value)];
    extinction = value >= 0.0 ? extinction : 0.0;
    if (CLIP_KEEP + CLIP_REMOVE > 0u) {
        vec3 at = BESIDE == 1u ? light.at.to_splats * (p - light.at.matter_at) : p;
        bool cuts = BESIDE == 0u || light.at.cuts_matter == 1u;
        extinction = cuts && is_cut_away(at, 0.0) ? 0.0 : extinction;
    }
    return extinction;
}

// Both shares in a word, times those that other volumes let through.
uint kept_share(uint code, uint before) {
    return BESIDE == 1u ? packUnorm2x16(unpackUnorm2x16(code) * unpackUnorm2x16(before)) : code;
}

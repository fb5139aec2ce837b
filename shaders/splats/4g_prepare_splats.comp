// Computes once per entry of a chunk what all its pixels share, instead of once per block of pixels that it may touch.
// docs/method.md, 4_prepare_splats.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bindings.h"
#include "shaders/shared/frame_params.h"

layout(local_size_x = 64) in;
#include "shaders/common/groups.glsl"
layout(constant_id = SPEC_FOOTPRINTS) const uint FOOTPRINTS = 2u;
layout(constant_id = SPEC_WARP) const uint WARP = FACE;
layout(constant_id = SPEC_NARROW) const uint NARROW = 0u;
layout(constant_id = SPEC_CREASES) const uint CREASES = 1u;
layout(constant_id = SPEC_TRACED) const uint TRACED = 1u;
layout(constant_id = SPEC_PAYLOAD) const uint PAYLOAD = 0u;
layout(constant_id = SPEC_SLICED) const uint SLICED = 0u;
layout(constant_id = SPEC_NODES) const uint NODES = 6u;
layout(constant_id = SPEC_TRANSFER) const uint TRANSFER = 0u;
layout(constant_id = SPEC_LIT_EDGES) const uint LIT_EDGES = 0u;
layout(constant_id = SPEC_CLIP_KEEP) const uint CLIP_KEEP = 0u;
layout(constant_id = SPEC_CLIP_REMOVE) const uint CLIP_REMOVE = 0u;
layout(constant_id = SPEC_ANTIALIAS) const uint ANTIALIAS = 0u;
#include "shaders/common/frame.glsl"
layout(binding = BIND_PREPARED, rgba32f) uniform writeonly image2D prepared;
layout(push_constant) uniform Push { uint chunk; };
#include "shaders/splats/splat_projection.glsl"
#include "shaders/light/shading.glsl"
#include "shaders/common/transfer.glsl"
#include "shaders/splats/splat_inputs.glsl"
#include "shaders/footprints/footprint.glsl"
#define KEEPS_PREPARED
#include "shaders/splats/prepared_splat.glsl"
#include "shaders/splats/sheet_of_entry.glsl"

void main() {
    uvec2 part = PairsRef(params.frame.chunks).at[chunk];
    uint entry = part.x + invocation_number();
    if (entry >= part.y) return;
    uint sheet = 0u;
    if (SLICED == 1u) sheet = sheet_of_entry(entry);
    uint own = enter_volume(UintsRef(params.frame.order).at[entry]);
    keep_prepared(entry, prepared_splat(own, sheet));
}

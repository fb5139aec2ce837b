// For every splat record of visible bricks: whether it is in the picture, its sheet, and the tiles or the sheet group's
// pixels that it touches. With a table of footprints: also its layers and their rotation.
// docs/method.md, pass 3.
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
layout(constant_id = SPEC_SLICED) const uint SLICED = 0u;
layout(constant_id = SPEC_CLIP_KEEP) const uint CLIP_KEEP = 0u;
layout(constant_id = SPEC_CLIP_REMOVE) const uint CLIP_REMOVE = 0u;
layout(constant_id = SPEC_ANTIALIAS) const uint ANTIALIAS = 0u;
layout(constant_id = SPEC_TILES) const uint TILES = 1u;
layout(constant_id = SPEC_CULLED) const uint CULLED = 0u;
#include "shaders/common/frame.glsl"
#include "shaders/splats/splat_projection.glsl"
#include "shaders/footprints/selected_footprint.glsl"
#include "shaders/common/rim.glsl"
#define CLIP_PARAMS params.of_volume
#include "shaders/common/clip.glsl"

// A box only grows, so a plain read avoids nearly all atomics.
void grow(GroupsRef groups, uint g, ivec4 box) {
    ivec4 now = groups.at[g].rect;
    if (box.x < now.x) atomicMin(groups.at[g].rect.x, box.x);
    if (box.y < now.y) atomicMin(groups.at[g].rect.y, box.y);
    if (box.z > now.z) atomicMax(groups.at[g].rect.z, box.z);
    if (box.w > now.w) atomicMax(groups.at[g].rect.w, box.w);
}

// Records the screen box of splat i for drawing in the sheets `first` to `last`.
void note(uint i, uint first, uint last, ivec4 box) {
    if (TILES == 1u) {
        uvec4 tiles = uvec4(uvec2(box.xy) / TILE, (uvec2(box.zw) + TILE - 1u) / TILE);
        PairsRef(params.frame.tile_rects).at[i] = uvec2(tiles.x | tiles.y << 16, tiles.z | tiles.w << 16);
        uint pairs = (tiles.z - tiles.x) * (tiles.w - tiles.y);
        for (uint s = first; s <= last; ++s) atomicAdd(UintsRef(params.frame.sheet_pairs).at[s], pairs);
    } else {
        for (uint g = first / params.frame.sheets_per_group; g <= last / params.frame.sheets_per_group; ++g)
            grow(GroupsRef(params.frame.groups), g, box);
    }
}

// Whether no ray of the picture can meet the front of the splat's face within its reach, nor pass it closely.
bool looks_away(uint i, Edge e, uint material, Projection p) {
    FaceTraits t = traits_of(i, e, material);
    vec3 to = p.position + p.centre - params.of_volume.eye;
    float away = length(to), turns = SURFACE_REACH * (bending_norm(t.h) + 1.0 / max(away - SURFACE_REACH, 1e-3));
    return !is_traced_at(i, e, p.view.z) && t.crease.away >= CREASE_REACH && dot(to, e.n) > away * turns;
}

void main() {
    uint slot = invocation_number();
    if (slot >= params.frame.slot_count) return;
    uint i = slot;
    bool there = true;
    if (CULLED == 1u) {
        uvec2 batch = PairsRef(params.frame.batches).at[slot / SPLAT_BATCH];
        there = slot % SPLAT_BATCH < batch.y;
        i = batch.x + min(slot % SPLAT_BATCH, batch.y - 1u);
    }
    uint own = enter_volume(i);
    Splat splat = SplatsRef(params.of_volume.splats).at[own];
    Edge e = unpack_edge(splat.normal, splat.edge);
    Projection p = place_splat(own, splat, e);
    project_support(p);
    ivec4 box = pixel_box(p);
    // A splat of a voxel on the face's far side uses the depth of its foot point. Beyond the kernel's radius, its
    // kernel contains none of the matter.
    float beside = WARP == FACE && e.state >= EDGE_LOWER ? min(e.d, 0.0) : 0.0;
    bool drawn = there && beside > -params.of_volume.support && p.visible && box.x < box.z && box.y < box.w;
    if (SURFACES == 1u) {
        beside = 0.0;
        drawn = drawn && !looks_away(own, e, splat.edge >> 28, p);
    }
    if (RIM == 1u) drawn = drawn && rim_share(p.position) > 0.0;
    if (CLIP_KEEP + CLIP_REMOVE > 0u) drawn = drawn && !is_cut_away(p.position + p.centre, reach_across(p) + (SURFACES == 1u ? SURFACE_EARLY : 0.0));
    if (FOOTPRINTS == TABLE && drawn) {
        uint material = splat.edge >> 28;
        PairsRef(params.frame.footprints).at[i] = select_footprint(e, is_in_table(own, e, material), p.position - params.of_volume.eye,
                                                                   params.of_volume.table_depth, traits_of(own, e, material).deepest);
    }
    int most = int(params.frame.sheet_count) - 1;
    if (SLICED == 1u) {
        // Depths relative to the first sheet, so that a far eye costs no precision.
        float middle = dot(params.of_volume.view_z, p.position + p.centre) - params.of_volume.sheet_zero;
        float reach = p.radius * length(params.of_volume.view_z);
        int first = clamp(int(floor((middle - reach) / params.frame.sheet_thickness)), 0, most);
        int last = clamp(int(floor((middle + reach) / params.frame.sheet_thickness)), first, most);
        UintsRef(params.frame.sheets).at[slot] = drawn ? uint(first) | uint(last - first) << SHEET_BITS : SHEET_NONE;
        if (drawn) note(i, uint(first), uint(last), box);
    } else {
        // The matter lies behind the face. Translucent matter is drawn one sheet before the matter that its face leads
        // to: no splat of another material may come between, and the occluder behind may not be in the same sheet.
        bool before = FACES && e.state >= EDGE_LOWER && (params.of_volume.translucent_mask >> (splat.edge >> 28) & 1u) == 1u;
        float apart = before ? params.frame.sheet_thickness / length(params.of_volume.view_z) : 0.0;
        float depth = p.view.z + (beside - apart) * dot(params.of_volume.view_z, e.n);
        // No vote lies further in front of its splat's sheet than sheet_ways() says.
        if (SURFACES == 1u) depth = p.depth - max(p.radius - votes_before(), 0.0) * length(params.of_volume.view_z);
        int sheet = max(int(floor(depth / params.frame.sheet_thickness)), 0) - params.frame.sheet_base;
        sheet = clamp(sheet, 0, most);
        UintsRef(params.frame.sheets).at[slot] = drawn ? uint(sheet) : SHEET_NONE;
        if (drawn) note(i, uint(sheet), uint(sheet), box);
    }
}

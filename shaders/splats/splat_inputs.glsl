// Data of a splat that is the same for all its pixels: position, footprint, colour. docs/method.md, pass 5. Include
// after shaders/splats/splat_projection.glsl, shading.glsl and transfer.glsl.
#ifndef EDGESPLAT_SPLAT_INPUTS_GLSL
#define EDGESPLAT_SPLAT_INPUTS_GLSL
#include "shaders/drivers/if_any.glsl"
#include "shaders/footprints/selected_footprint.glsl"
#include "shaders/footprints/kernel.glsl"
#include "shaders/common/rim.glsl"

// With surface splats, the first three numbers of FaceForm::cut are the foot point, and color_sigma.w is the reach.
layout(constant_id = SPEC_LABELS) const uint LABELS = 0u;

struct SplatInputs {
    vec3 from_eye;         // voxel centre minus eye, index space
    vec4 color_sigma;      // payload, extinction per mm
    vec4 normal_distance;  // n, D
    vec3 shape;            // negative: the splat is not warped; then depths of the slice (mm from the voxel)
    vec3 matter;           // unlit colour, for cuts; only with clip planes
    uvec2 number_material; // number of the splat; material and lighting bits; only with clip planes or faces
    FaceForm face;         // only with faces; light is evaluated where a ray meets it, and color_sigma contains the unlit colour
    vec4 filtered;         // share, weights of distances in pixels and voxels, amplitude; only with antialias
    SelectedFootprint selected;  // only with a table
};

// No voxel beyond the volume's border carries matter. The outermost voxels get this weight instead, which keeps the
// amount of matter.
float border_weight(ivec3 voxel) {
    ivec3 dims = params.of_volume.dims;
    ivec3 outermost = ivec3(equal(voxel, ivec3(0))) + ivec3(equal(voxel, dims - 1));
    return pow(BORDER_WEIGHT, float(outermost.x + outermost.y + outermost.z));
}

SplatInputs splat_inputs(uint number, Splat splat, Edge e, Projection p, vec2 depths) {
    SplatInputs s;
    s.from_eye = p.position - params.of_volume.eye;
    vec4 material = vec4(0.0);
    if (TRANSFER == 1u && (TOGETHER == 0u || params.of_volume.has_transfer == 1u))
        material = transfer_at(TransferRef(params.of_volume.transfer), ClassifiedRef(params.of_volume.values).at[number]);
    else
        material = params.of_volume.materials[splat.edge >> 28];
    // Surfaces find their labels where rays meet them (engine/geometry/seen_label.glsl).
    if (LABELS != 0u && SURFACES == 0u && (TOGETHER == 0u || params.of_volume.has_labels == 1u)) {
        uint label = UintsRef(params.of_volume.labels).at[number], first = TOGETHER == 1u ? params.of_volume.first_label : 0u;
        material.rgb = label == 0u ? material.rgb : ColorsRef(params.frame.label_colors).at[first + label - 1u];
    }
    bool lit_edges = LIT_EDGES == 1u && (TOGETHER == 0u || params.of_volume.lit_edges == 1u);
    bool through = (params.of_volume.translucent_mask >> (splat.edge >> 28) & 1u) == 1u;
    if (FACES) material.a *= through ? border_weight(ivec3(round(p.position + params.of_volume.anchor))) : 1.0;
    if (RIM == 1u) material.a *= rim_share(p.position);
    // The outward normal points to lower values, on either side of the surface.
    vec3 outward = e.state == EDGE_UPPER ? -e.n : e.n;
    vec3 world_normal = e.state == EDGE_NONE ? vec3(0.0) : normalize(params.of_volume.normal_to_world * outward);
    vec3 world_from_eye = params.of_volume.index_to_world * s.from_eye;
    vec3 to_eye = -unit_or_zero(world_from_eye);
    // A wall's kernel reaches both faces; the visible one faces the eye.
    bool turned = FOOTPRINTS != 0u && e.state >= EDGE_LOWER && e.d2 < params.of_volume.band && dot(world_normal, to_eye) < 0.0;
    if (turned) world_normal = -world_normal;
    float depth = SLICED == 1u ? p.view.z + clamp(0.0, depths.x, depths.y) : p.view.z;
    vec3 payload = vec3(0.0);
    if (PAYLOAD == PAYLOAD_COLOR) {
        bool has_normal = e.state >= (lit_edges ? EDGE_LOWER : EDGE_NORMAL);
        payload = shade(Surface(material.rgb, response_of(splat.edge >> 28), lights_reach(number), has_normal, world_normal, ambient_reach(number, turned), world_from_eye, to_eye, depth));
    }
    if (PAYLOAD == PAYLOAD_DEPTH_DISTANCE) {
        float signed_distance = e.state == EDGE_LOWER ? -e.d : e.state == EDGE_UPPER ? e.d : -params.of_volume.band;
        payload = vec3(depth, signed_distance, 0.0);
    }
    if (PAYLOAD == PAYLOAD_NORMAL) payload = world_normal;
    s.color_sigma = vec4(payload, material.a);
    s.number_material = uvec2(number, splat.edge >> 28);
    if (FACES) {
        bool is_cut = e.state >= EDGE_LOWER && e.d < params.of_volume.support + FACE_DEPTH;
        bool has_normal = e.state >= (PAYLOAD == PAYLOAD_COLOR && lit_edges ? EDGE_LOWER : EDGE_NORMAL);
        s.number_material.y |= (e.state == EDGE_UPPER ? FACES_UPWARD : 0u) | (has_normal ? HAS_NORMAL : 0u);
        s.face = plain_form(e.state == EDGE_NONE ? vec3(0.0) : e.n);
        IF_ANY(is_cut) {
            FaceTraits traits = traits_of(number, e, splat.edge >> 28);
            FaceCut cut = FaceCut(e.d * e.n.x, e.d * e.n.y, e.d * e.n.z, 0.0, 0.0);
            if (SURFACES == 0u) cut = cut_of(e, traits, params.of_volume.band, CREASES == 1u);
            vec3 a = abs(e.n);
            uint axis = a.x >= a.y && a.x >= a.z ? 0u : a.y >= a.z ? 1u : 2u;
            s.number_material.y |= (axis | (e.n[axis] < 0.0 ? 4u : 0u)) << MAIN_AXIS_AT;
            s.number_material.y |= (BendingsRef(params.of_volume.traits).at[number].x & FACE_MIXED) != 0u ? IS_MIXED : 0u;
            s.face = face_form_of(e, traits, cut);
        }
        if (TRACED == 1u) s.number_material.y |= e.state >= EDGE_LOWER && is_traced_at(number, e, p.view.z) ? IS_TRACED : 0u;
        if (PAYLOAD == PAYLOAD_COLOR) s.color_sigma.rgb = material.rgb;
        if (SURFACES == 1u) s.color_sigma.w = (s.number_material.y & IS_TRACED) != 0u ? trace_reach(e.d2) : SURFACE_REACH;
    }
    if (FOOTPRINTS == TABLE) s.selected = unpack_footprint(PairsRef(params.frame.footprints).at[number_in_list(number)], params.of_volume.table_depth);
    if (CLIP_KEEP + CLIP_REMOVE > 0u) s.matter = material.rgb;
    s.normal_distance = vec4(e.n, e.d);
    bool warped = FOOTPRINTS != 0u && e.state >= EDGE_LOWER && (FACES ? e.d < params.of_volume.support + FACE_DEPTH : abs(e.d) < params.of_volume.band);
    s.shape = vec3(warped ? 1.0 : -1.0, depths);
    if (ANTIALIAS == 1u) {
        LowPass f = p.filtered;
        float matter = warped ? matter_between(e.d, e.d2, through) : 1.0;
        s.filtered = vec4(f.share, f.of_pixels, f.of_voxels, matter * sqrt(f.of_voxels));
        if (f.share >= 1.0) s.shape.x = -1.0;
        if (FACES && f.share >= 1.0) s.face.cut.depth = -1.0;
    }

    return s;
}
#endif

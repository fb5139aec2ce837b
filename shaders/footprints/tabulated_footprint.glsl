// Takes footprints from the table if it contains them, and integrates all others. Include after cut_footprint() in
// shaders/splats/splat_value.glsl. The including shader declares `selected_footprint` and the sampler
// `footprint_layers`.
#ifndef EDGESPLAT_TABULATED_FOOTPRINT_GLSL
#define EDGESPLAT_TABULATED_FOOTPRINT_GLSL
#include "shaders/drivers/if_any.glsl"

float table_texel(float x, float y, float layer) {
    return textureLod(footprint_layers, vec3((x + 0.5) / float(TABLE_WIDTH), (y + 0.5) / float(TABLE_ROWS), layer), 0.0).r;
}
#include "footprints/table_lookup.glsl"

float along_axis;  // coordinate of the ray along the axis, from the voxel; set by splat_value()

// Integrates if pass 3 marked the splat as INTEGRATED, or if the volume's border or a clip plane cuts the kernel on
// this ray.
FaceFootprint tabulated_footprint(FaceSight sight, vec3 p, vec3 u, bool plain, Slice inside, Slice slice) {
    float half_chord = sqrt(max(face_form.cut.reach2 - sight.ray.rho2, 0.0));
    Slice own = Slice(plain ? slice.low : inside.low, plain ? slice.high : inside.high);
    bool whole = (selected_footprint.layer.code & INTEGRATED) == 0u && own.low <= -half_chord && own.high >= half_chord;
    FaceFootprint f = FaceFootprint(0.0, FaceEnd(0.0, 1.0, 0), FaceEnd(0.0, 1.0, 0));
    IF_ANY(!whole) f = cut_footprint(sight, p, u, plain, inside, slice);
    float table_value = half_chord > 0.0 ? footprint_looked_up(selected_footprint.layer, along_axis, sight.ray.rho2) : 0.0;
    // The point where the ray passes through the face, clamped to the kernel's reach.
    float b = sight.ray.phi.b, at_face = -sight.ray.phi.c / (b < 0.0 ? min(b, -FACE_STRAIGHT) : max(b, FACE_STRAIGHT));
    at_face = clamp(at_face, -half_chord, half_chord);
    f.integral = whole ? table_value : f.integral;
    f.entry.z = whole ? (plain ? 0.0 : b < 0.0 ? at_face : -half_chord) : f.entry.z;
    f.leave.z = whole ? (b < 0.0 ? half_chord : at_face) : f.leave.z;
    return f;
}
#endif

// One splat in one pixel: (tau * colour, tau) with tau the optical depth of its kernel along the pixel's ray.
// docs/method.md, pass 5; design (8).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/bindings.h"
#include "shaders/shared/frame_params.h"
layout(constant_id = SPEC_FOOTPRINTS) const uint FOOTPRINTS = 2u;
layout(constant_id = SPEC_WARP) const uint WARP = FACE;
layout(constant_id = SPEC_NARROW) const uint NARROW = 0u;
layout(constant_id = SPEC_CREASES) const uint CREASES = 1u;
layout(constant_id = SPEC_SLICED) const uint SLICED = 0u;
layout(constant_id = SPEC_NODES) const uint NODES = 6u;
layout(constant_id = SPEC_PAYLOAD) const uint PAYLOAD = 0u;
layout(constant_id = SPEC_CLIP_KEEP) const uint CLIP_KEEP = 0u;
layout(constant_id = SPEC_CLIP_REMOVE) const uint CLIP_REMOVE = 0u;
layout(constant_id = SPEC_ANTIALIAS) const uint ANTIALIAS = 0u;
layout(constant_id = SPEC_PIECES) const uint FACE_PIECES = 2u;
const uint MIXED = 0u;
const float ray_end = 0.0;

layout(early_fragment_tests) in;
#include "shaders/common/frame.glsl"
layout(binding = BIND_TABLE) uniform sampler2DArray footprint_layers;
layout(push_constant) uniform Push { uint group; };

layout(location = 0) flat in vec4 start_plane;
layout(location = 1) flat in vec3 from_eye;
layout(location = 2) flat in vec4 color_sigma;
layout(location = 3) flat in vec4 normal_distance;
layout(location = 4) flat in vec3 shape;
layout(location = 5) flat in vec2 slopes;
layout(location = 6) flat in vec3 matter;
layout(location = 7) flat in uvec2 number_and_material;
layout(location = 8) flat in vec4 filtered;
layout(location = 9) flat in vec4 face_slope;
layout(location = 10) flat in vec4 face_diagonal;
layout(location = 11) flat in vec4 face_mixed;
layout(location = 12) flat in vec2 face_reach2_corner;
layout(location = 13) flat in vec4 first_selected;
layout(location = 14) flat in vec4 second_selected;
layout(location = 15) flat in vec4 crease;
layout(location = 0) out vec4 sheet;

#include "shaders/footprints/face_form.glsl"
FaceForm face_form;
uvec2 number_material;
vec2 pixels;  // from the voxel's centre to the fragment; only with antialias
#include "shaders/edges/edge_record.glsl"
#include "shaders/footprints/selected_footprint.glsl"
SelectedFootprint selected_footprint;

#include "shaders/splats/splat_value.glsl"

void main() {
    number_material = number_and_material;
    if (FACES)
        face_form = FaceForm(face_slope.w, face_slope.xyz, Bending(face_diagonal.xyz, face_mixed.xyz),
                             FaceCut(face_diagonal.w, face_mixed.w, face_reach2_corner.x, 0.0, 0.0), Plane(crease.xyz, crease.w), face_reach2_corner.y);
    if (FOOTPRINTS == TABLE) selected_footprint = from_texels(first_selected, second_selected);
    // Computed from the pixel, not interpolated: devices round the corners of quads to fractions of a pixel.
    vec2 slope = (gl_FragCoord.xy * 2.0 / vec2(params.frame.size) - 1.0) * vec2(params.frame.tan_half_x, params.frame.tan_half_y);
    vec3 offset = start_plane.xyz + start_plane.w * (slope.x * params.of_volume.ray_x + slope.y * params.of_volume.ray_y);
    if (ANTIALIAS == 1u) pixels = (slope - slopes) / params.frame.pixel;
    vec3 u = normalize(from_eye + offset);
    vec3 p = offset - dot(offset, u) * u;
    if (FACES) volume_piece = piece_in_volume(u);
    sheet = splat_value(p, u, dot(from_eye, u), length(params.of_volume.index_to_world * u));
}

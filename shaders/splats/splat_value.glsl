// One splat in one pixel: (tau * colour, tau) with tau the optical depth of its kernel along the pixel's ray.
// docs/method.md, pass 5; design (8). The including shader declares the uniform block `params.frame`, the constants of
// the draw, `ray_end` and the results of shaders/splats/splat_inputs.glsl as variables: with faces `face_form`; with antialias
// `pixels`, the offset from the voxel's centre.
#ifndef EDGESPLAT_SPLAT_VALUE_GLSL
#define EDGESPLAT_SPLAT_VALUE_GLSL
#include "shaders/drivers/if_any.glsl"
#include "shaders/footprints/footprint.glsl"
#include "shaders/footprints/face_form.glsl"
#include "footprints/face.glsl"
#include "shaders/drivers/if_any.glsl"
#include "engine/geometry/face_sight.glsl"
#define CLIP_PARAMS params.of_volume
#include "shaders/common/clip.glsl"
#include "shaders/common/clip_ray.glsl"
#include "footprints/in_float.glsl"
#include "engine/geometry/volume_ends.glsl"
#include "engine/geometry/lit_path.glsl"
#include "shaders/light/shading.glsl"

// Whether a point lies in a splat's matter: in its kernel, and on the voxel's own side of the plane that warps it. r2:
// squared distance from the voxel; t: coordinate along n. A ray that enters at this point shows the cut.
bool is_in_matter(float r2, float t, float D, bool plain, FootprintParams params) {
    float reach = plain ? KERNEL_R : params.paper_reach;
    return r2 < reach * reach && (plain || t < D);
}

float footprint(float rho2, float pn, float un, Slice slice) {
    if (FOOTPRINTS == ISOTROPIC) return footprint_isotropic(rho2, slice);
    float d = normal_distance.w;
    float warped = FOOTPRINTS == WARP2D ? footprint_paper_warp2d(rho2, pn, un, d, slice, params.frame.footprint)
                                        : footprint_paper_procedural(rho2, pn, un, d, slice, params.frame.footprint);
    return shape.x < 0.0 ? footprint_isotropic(rho2, slice) : warped;
}

// |x|^2 in the metric of the widened kernel, at the ray's point nearest to the voxel.
float filtered_rho2(float rho2) { return filtered.y * dot(pixels, pixels) + filtered.z * rho2; }

// z from p where the ray passes the voxel's depth. The pixel filter lies across the view, so kernels keep their depths.
float voxel_depth_on_ray(vec3 p, vec3 u) { return -dot(params.of_volume.view_z, p) / dot(params.of_volume.view_z, u); }

// The footprint, blended with the widened one according to the pixel size. `z`: voxel_depth_on_ray.
float drawn_footprint(float rho2, float pn, float un, float z, Slice slice) {
    float value = footprint(rho2, pn, un, slice);
    if (ANTIALIAS == 1u) {
        float wide = filtered.w * footprint_isotropic(filtered_rho2(rho2), Slice(slice.low - z, slice.high - z));
        value = filtered.x > 0.0 ? mix(value, wide, filtered.x) : value;
    }
    return value;
}

// Payload of a splat where a ray enters its matter through a clip plane, at z from p.
vec3 cap_payload(vec3 face, vec3 p, vec3 u, float z) {
    vec3 world_normal = normalize(params.of_volume.normal_to_world * face);
    if (PAYLOAD == PAYLOAD_NORMAL) return world_normal;
    float depth = dot(params.of_volume.view_z, from_eye + p + z * u);
    if (PAYLOAD == PAYLOAD_DEPTH_DISTANCE) return vec3(depth, color_sigma.g, 0.0);
    vec3 entry = params.of_volume.index_to_world * (from_eye + p + z * u);
    vec3 to_eye = -normalize(params.of_volume.index_to_world * u);
    return shade(Surface(matter, response_of(number_material.y & MATERIAL_BITS), lights_reach(number_material.x), true, world_normal, ambient_reach(number_material.x, false), entry, to_eye, depth));
}

// The piece of the pixel's ray in the volume. The volume's border cuts kernels as a face does. low, high: from the eye
// along u; normals: world, unit. Set by the drawing shader if faces cut kernels.
struct VolumePiece {
    float low;
    float high;
    vec3 normal;
    vec3 far_normal;  // where the ray leaves the volume; only with translucent matter
};
VolumePiece volume_piece;

VolumePiece piece_in_volume(vec3 u) {
    vec3 way = divisible(u);
    VolumeEnds ends = volume_ends(params.of_volume.anchor + params.of_volume.eye, way, params.of_volume.dims);
    mat3 to_world = params.of_volume.normal_to_world;
    VolumePiece piece = VolumePiece(entry_of(ends), exit_of(ends), normalize(to_world * out_of_entry(ends, way)), vec3(0.0));
    if (FACE_PIECES == 2u) piece.far_normal = normalize(to_world * out_of_exit(ends, way));
    return piece;
}

// Payload of the surface at one end of the ray's piece in the kernel. `border`: the volume's normal if the piece ends
// at the border, else 0. `ahead`: distance along u from the eye to p.
vec3 face_payload(FaceSight sight, FaceEnd end, vec3 border, vec3 u, float ahead) {
    bool upward = (number_material.y & FACES_UPWARD) != 0u, has_normal = (number_material.y & HAS_NORMAL) != 0u;
    vec3 slope = normal_at(sight, end, CREASES == 1u);
    // Both faces of a layer between two iso-values face the lower values.
    uint axis = number_material.y >> MAIN_AXIS_AT;
    float along = (axis & 3u) == 0u ? slope.x : (axis & 3u) == 1u ? slope.y : slope.z;
    bool is_other = ((axis & 4u) != 0u ? -along : along) < 0.0;
    upward = upward != ((number_material.y & IS_MIXED) != 0u && is_other);
    vec3 outward = upward ? -slope : slope;
    vec3 world_normal = has_normal ? unit_or_zero(params.of_volume.normal_to_world * outward) : vec3(0.0);
    bool at_border = dot(border, border) > 0.0;
    if (at_border) world_normal = border;
    if (PAYLOAD == PAYLOAD_NORMAL) return world_normal;
    vec3 way = params.of_volume.index_to_world * u;
    // Matter around the eye is seen right in front of it.
    float away = max(ahead + end.z, 1e-4), depth = away * dot(params.of_volume.view_z, u);
    if (PAYLOAD == PAYLOAD_DEPTH_DISTANCE) return vec3(depth, color_sigma.g, 0.0);
    return shade(Surface(color_sigma.rgb, response_of(number_material.y & MATERIAL_BITS), lights_reach(number_material.x), has_normal || at_border, world_normal,
                         ambient_reach(number_material.x, end.side < 0.0), away * way, -normalize(way), depth));
}

// The visible part of the kernel on the ray: within `slice` for a plain kernel, within `inside` for a cut one.
FaceFootprint cut_footprint(FaceSight sight, vec3 p, vec3 u, bool plain, Slice inside, Slice slice) {
    FaceCrease crease;
    if (CREASES == 1u) crease = crease_seen(p, u);
    FaceFootprint f = footprint_face(sight.ray, face_form.cut, CREASES == 1u, crease, inside);
    f.integral = plain ? footprint_isotropic(sight.ray.rho2, slice) : f.integral;
    if (plain) f.entry = FaceEnd(0.0, 1.0, 0);
    return f;
}
#include "shaders/footprints/tabulated_footprint.glsl"

// Payload of the splat for a ray through it. In translucent matter light is evaluated in depth: the nearer half is lit
// like the entry, the farther half like the exit.
vec3 seen_payload(FaceSight sight, FaceFootprint f, bool plain, float border, float far_border, vec3 u, float ahead, float mm) {
    bool at_border = !plain && volume_piece.low > 0.0 && border > f.entry.z;
    if (ANTIALIAS == 1u) {
        // A ray enters a widened kernel where the ray through the voxel's centre would.
        float along = dot(face_form.slope, u), begin = along < 0.0 ? -face_form.value / along : -KERNEL_R;
        at_border = at_border || (plain && face_form.value < 0.0 && volume_piece.low > 0.0 && border > max(begin, -KERNEL_R));
    }
    f.entry.z = at_border ? border : f.entry.z;
    vec3 normal = at_border ? volume_piece.normal : vec3(0.0);
    if (FACE_PIECES == 1u || PAYLOAD != PAYLOAD_COLOR || LIGHTS + SILHOUETTE + FOG == 0u) return face_payload(sight, f.entry, normal, u, ahead);
    bool deep = !plain && (params.of_volume.translucent_mask >> (number_material.y & MATERIAL_BITS) & 1u) == 1u;
    bool layer = deep && (number_material.y & IS_MIXED) != 0u;
    float half_chord = sqrt(max(KERNEL_R2 - sight.ray.rho2, 0.0));
    LitPath path = lit_path(f.entry.z, f.leave.z, at_border, far_border, half_chord, color_sigma.a * mm, layer, sight.ray.phi);
    f.entry.z = deep ? path.near : f.entry.z;
    f.leave.z = path.far;
    vec3 near = face_payload(sight, f.entry, normal, u, ahead);
    vec3 far = face_payload(sight, f.leave, path.to_border ? volume_piece.far_normal : vec3(0.0), u, ahead);
    return deep ? mix(near, far, path.share) : near;
}

// (integral * payload, integral) of the ray within `slice`. `z`: voxel_depth_on_ray; `mm`: length of a voxel along u.
vec4 face_value(FaceSight sight, vec3 p, vec3 u, float ahead, float z, Slice slice, float mm) {
    bool plain = face_form.cut.depth < 0.0;
    float border = volume_piece.low - ahead, far_border = volume_piece.high - ahead;
    Slice inside = Slice(max(slice.low, border), min(slice.high, far_border));
    FaceFootprint f;
    if (FOOTPRINTS == TABLE) f = tabulated_footprint(sight, p, u, plain, inside, slice);
    else f = cut_footprint(sight, p, u, plain, inside, slice);
    if (ANTIALIAS == 1u) {
        float wide = filtered.w * footprint_isotropic(filtered_rho2(sight.ray.rho2), Slice(slice.low - z, slice.high - z));
        f.integral = filtered.x > 0.0 ? mix(f.integral, wide, filtered.x) : f.integral;
    }
    vec3 payload = PAYLOAD == PAYLOAD_TAU ? vec3(0.0) : seen_payload(sight, f, plain, border, far_border, u, ahead, mm);
    return f.integral * vec4(payload, 1.0);
}

// The splat within `slice`, on the pieces of the ray that clip planes keep: (sum of integral * payload, sum of
// integral).
vec4 clipped_footprint(vec3 p, vec3 u, float ahead, Slice slice, float mm) {
    FaceSight sight;
    if (FACES) sight = face_sight(p, u);
    float rho2 = dot(p, p), pn = dot(p, normal_distance.xyz), un = dot(u, normal_distance.xyz);
    Kept kept = kept_pieces(from_eye + params.of_volume.eye + p, u, -dot(from_eye, u));
    // Ends this far from the voxel do not cut its kernel; a whole piece has a closed form.
    float z = ANTIALIAS == 1u ? voxel_depth_on_ray(p, u) : 0.0;
    float far = ANTIALIAS == 1u ? 8.0 + abs(z) : 8.0;
    vec4 sum = vec4(0.0);
    bool some = kept.before.low < kept.before.high && kept.before.low < far && kept.before.high > -far;
    bool more = CLIP_REMOVE > 0u && kept.behind.low < kept.behind.high && kept.behind.low < far && kept.behind.high > -far;
    int first = some ? 0 : 1, last = more ? 2 : 1;
    for (int i = first; i < last; ++i) {
        Slice piece = CLIP_REMOVE > 0u && i == 1 ? kept.behind : kept.before;
        vec3 face = CLIP_REMOVE > 0u && i == 1 ? kept.behind_face : kept.before_face;
        float t = pn + piece.low * un;
        float matter2 = rho2 + piece.low * piece.low;
        if (ANTIALIAS == 1u && filtered.x >= 1.0) matter2 = filtered_rho2(rho2) + (piece.low - z) * (piece.low - z);
        bool cap = PAYLOAD != PAYLOAD_TAU && dot(face, face) > 0.0 &&
                   is_in_matter(matter2, t, normal_distance.w, FOOTPRINTS == ISOTROPIC || shape.x < 0.0, params.frame.footprint);
        if (FACES) {
            bool plain = face_form.cut.depth < 0.0;
            Slice here = Slice(piece.low, piece.low + 1e-3);
            bool inside = cut_footprint(sight, p, u, plain, here, here).integral > 0.0;
            cap = PAYLOAD != PAYLOAD_TAU && dot(face, face) > 0.0 && (plain ? matter2 < KERNEL_R2 : inside);
        }
        vec3 payload = color_sigma.rgb;
        IF_ANY(cap) payload = cap_payload(face, p, u, piece.low);
        Slice cut = Slice(piece.low < -far ? -1e9 : piece.low, piece.high > far ? 1e9 : piece.high);
        cut = Slice(max(cut.low, slice.low), min(cut.high, slice.high));
        if (FACES) {
            vec4 value = vec4(0.0);
            IF_ANY(cut.low < cut.high) value = face_value(sight, p, u, ahead, z, cut, mm);
            sum += vec4(cap ? value.a * payload : value.rgb, value.a);
            continue;
        }
        float value = cut.low < cut.high ? drawn_footprint(rho2, pn, un, z, cut) : 0.0;
        sum += value * vec4(payload, 1.0);
    }
    return sum;
}

// (tau * payload, tau) of the ray with direction u (index space, unit). p: its point nearest to the voxel, relative to
// the voxel. `ahead`: distance along u from the eye to p; `mm`: length of a voxel along u.
vec4 splat_value(vec3 p, vec3 u, float ahead, float mm) {
    Slice slice = Slice(-1e9, 1e9);
    float in_front = 1.0;
    if (FOOTPRINTS == TABLE) along_axis = dot(p, selected_footprint.axis);
    if (SLICED == 1u) {
        float depth_along = dot(params.of_volume.view_z, u);
        vec2 z = (shape.yz - dot(params.of_volume.view_z, p)) / depth_along;
        slice = Slice(z.x, z.y);
    } else if (CLIP_KEEP + CLIP_REMOVE == 0u) {
        // Only the part of the kernel in front of the eye counts.
        in_front = smoothstep(-params.of_volume.support, params.of_volume.support, ahead);
    }
    if (MIXED == 1u) {
        // A kernel at the end of the ray is cut at the eye, too, so that nothing is left if the ray ends there.
        bool ends = ray_end - ahead < KERNEL_R;
        slice = Slice(ends ? -ahead : slice.low, ends ? ray_end - ahead : slice.high);
        in_front = ends ? 1.0 : in_front;
    }
    if (CLIP_KEEP + CLIP_REMOVE > 0u) return color_sigma.a * mm * clipped_footprint(p, u, ahead, slice, mm);
    float z = ANTIALIAS == 1u ? voxel_depth_on_ray(p, u) : 0.0;
    if (FACES) return color_sigma.a * mm * in_front * face_value(face_sight(p, u), p, u, ahead, z, slice, mm);
    float value = drawn_footprint(dot(p, p), dot(p, normal_distance.xyz), dot(u, normal_distance.xyz), z, slice);
    float tau = color_sigma.a * mm * value * in_front;
    return vec4(tau * color_sigma.rgb, tau);
}
#endif

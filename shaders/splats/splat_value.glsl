// One splat at one pixel: the optical depth of its kernel along the pixel's own ray, and that times its colour.
// docs/method.md, pass 5; design (8). The including shader declares the uniform block `params.frame`, the constants of the
// draw, and what shaders/splats/splat_inputs.glsl finds, as variables, of faces `face_form`; with antialias `pixels`, from the voxel's centre.
#ifndef EDGESPLAT_SPLAT_VALUE_GLSL
#define EDGESPLAT_SPLAT_VALUE_GLSL
#include "shaders/footprints/footprint.glsl"
#include "shaders/footprints/face_form.glsl"
#include "shaders/footprints/face.glsl"
#define CLIP_PARAMS params.frame
#include "shaders/common/clip.glsl"
#include "shaders/common/clip_ray.glsl"
#include "shaders/light/shading.glsl"

float footprint(float rho2, float pn, float un, Slice slice) {
    if (FOOTPRINTS == ISOTROPIC) return footprint_isotropic(rho2, slice);
    float d = normal_distance.w;
    float warped = FOOTPRINTS == WARP2D ? footprint_paper_warp2d(rho2, pn, un, d, slice, params.frame.footprint)
                                        : footprint_paper_procedural(rho2, pn, un, d, slice, params.frame.footprint);
    return shape.x < 0.0 ? footprint_isotropic(rho2, slice) : warped;
}

// |x|^2 of the widened kernel where the ray passes it.
float filtered_rho2(float rho2) { return filtered.y * dot(pixels, pixels) + filtered.z * rho2; }

// Where the ray passes the voxel's depth, z from p: the pixel's filter lies across the view, and so its kernels keep their depths.
float voxel_depth_on_ray(vec3 p, vec3 u) { return -dot(params.frame.view_z, p) / dot(params.frame.view_z, u); }

// The footprint, or as much of the widened one as the pixel's size calls for. `z`: voxel_depth_on_ray.
float drawn_footprint(float rho2, float pn, float un, float z, Slice slice) {
    float value = footprint(rho2, pn, un, slice);
    if (ANTIALIAS == 1u) {
        float wide = filtered.w * footprint_isotropic(filtered_rho2(rho2), Slice(slice.low - z, slice.high - z));
        value = filtered.x > 0.0 ? mix(value, wide, filtered.x) : value;
    }
    return value;
}

// What a splat carries where a ray enters its matter through a clip plane, z from p.
vec3 cap_payload(vec3 face, vec3 p, vec3 u, float z) {
    vec3 world_normal = normalize(params.frame.normal_to_world * face);
    if (PAYLOAD == PAYLOAD_NORMAL) return world_normal;
    float depth = dot(params.frame.view_z, from_eye + p + z * u);
    if (PAYLOAD == PAYLOAD_DEPTH_DISTANCE) return vec3(depth, color_sigma.g, 0.0);
    vec3 entry = params.frame.index_to_world * (from_eye + p + z * u);
    vec3 to_eye = -normalize(params.frame.index_to_world * u);
    return shade(Surface(matter, number_material.y, number_material.x, true, world_normal, false, entry, to_eye, depth));
}

// What a ray sees of the splat's face. z counts from p, its point nearest to the voxel.
struct FaceSight {
    FaceRay ray;
    vec3 slope;  // grad phi at p
    vec3 turn;   // of it along u
};

FaceSight face_sight(vec3 p, vec3 u) {
    vec3 hp = bent(face_form.h, p), hu = bent(face_form.h, u);
    vec3 slope = face_form.slope + hp;
    FaceRay ray;
    ray.rho2 = dot(p, p);
    ray.phi = Quadratic(face_form.value + 0.5 * dot(face_form.slope + slope, p), dot(slope, u), 0.5 * dot(u, hu));
    ray.slope2 = Quadratic(dot(slope, slope), 2.0 * dot(slope, hu), dot(hu, hu));
    ray.across = dot(p, slope);
    ray.turn = dot(p, hu);
    return FaceSight(ray, slope, hu);
}

// The pixel's ray in the volume, whose border cuts kernels as a face does: from the eye along u, and the border's normal
// where it enters (world, unit). Whoever draws sets it where kernels are cut at faces.
struct VolumePiece {
    float low;
    float high;
    vec3 normal;
};
VolumePiece volume_piece;

VolumePiece piece_in_volume(vec3 u) {
    vec3 way = mix(u, vec3(1e-8), lessThan(abs(u), vec3(1e-8)));
    vec3 from = params.frame.anchor + params.frame.eye;
    vec3 a = (vec3(-0.5) - from) / way, b = (vec3(params.frame.dims) - 0.5 - from) / way;
    bvec3 flat_axis = equal(params.frame.dims, ivec3(1));
    vec3 near = mix(min(a, b), vec3(-1e9), flat_axis), far = mix(max(a, b), vec3(1e9), flat_axis);
    float low = max(near.x, max(near.y, near.z));
    bool x = near.x >= low, y = !x && near.y >= low;
    vec3 out_of = -sign(way) * vec3(x, y, !x && !y);
    return VolumePiece(low, min(far.x, min(far.y, far.z)), normalize(params.frame.normal_to_world * out_of));
}

FaceCrease crease_seen(vec3 p, vec3 u) {
    vec4 plane = face_form.crease;
    return FaceCrease(dot(plane.xyz, p), dot(plane.xyz, u), plane.w, dot(plane.xyz, face_form.slope));
}

// What the surface shows where the ray meets it, z from p; `at_border`: it enters the volume there. `ahead`: of the eye's way to p.
vec3 face_payload(FaceSight sight, float z, float side, bool from_crease, vec3 u, float ahead, bool at_border) {
    bool upward = (number_material.y & FACES_UPWARD) != 0u, has_normal = (number_material.y & HAS_NORMAL) != 0u;
    vec3 slope = sight.slope + z * sight.turn;
    if (CREASES == 1u) slope = from_crease ? face_form.crease.xyz : slope;
    // Both faces of a layer between two iso-values face the lower values.
    uint axis = number_material.y >> MAIN_AXIS_AT;
    float along = (axis & 3u) == 0u ? slope.x : (axis & 3u) == 1u ? slope.y : slope.z;
    bool is_other = ((axis & 4u) != 0u ? -side : side) * along < 0.0;
    upward = upward != ((number_material.y & IS_MIXED) != 0u && is_other);
    vec3 outward = (upward ? -side : side) * slope;
    vec3 world_normal = has_normal ? unit_or_zero(params.frame.normal_to_world * outward) : vec3(0.0);
    if (at_border) world_normal = volume_piece.normal;
    if (PAYLOAD == PAYLOAD_NORMAL) return world_normal;
    vec3 way = params.frame.index_to_world * u;
    // What the eye is in is seen right before it.
    float away = max(ahead + z, 1e-4), depth = away * dot(params.frame.view_z, u);
    if (PAYLOAD == PAYLOAD_DEPTH_DISTANCE) return vec3(depth, color_sigma.g, 0.0);
    return shade(Surface(color_sigma.rgb, number_material.y & MATERIAL_BITS, number_material.x, has_normal || at_border, world_normal, side < 0.0,
                         away * way, -normalize(way), depth));
}

// What is left of the kernel on the ray: between `slice`, and of one that is cut, within `inside`.
FaceFootprint cut_footprint(FaceSight sight, vec3 p, vec3 u, bool plain, Slice inside, Slice slice) {
    FaceCrease crease;
    if (CREASES == 1u) crease = crease_seen(p, u);
    FaceFootprint f = footprint_face(sight.ray, face_form.cut, CREASES == 1u, crease, inside);
    f.integral = plain ? footprint_isotropic(sight.ray.rho2, slice) : f.integral;
    f.entry = plain ? 0.0 : f.entry;
    f.side = plain ? 1.0 : f.side;
    f.from_crease = !plain && f.from_crease;
    return f;
}
#include "shaders/footprints/tabulated_footprint.glsl"

// (integral times payload, integral) of the ray between `slice`; `z`: voxel_depth_on_ray.
vec4 face_value(FaceSight sight, vec3 p, vec3 u, float ahead, float z, Slice slice) {
    bool plain = face_form.cut.depth < 0.0;
    float border = volume_piece.low - ahead;
    Slice inside = Slice(max(slice.low, border), min(slice.high, volume_piece.high - ahead));
    FaceFootprint f;
    if (FOOTPRINTS == TABLE) f = tabulated_footprint(sight, p, u, plain, inside, slice);
    else f = cut_footprint(sight, p, u, plain, inside, slice);
    bool at_border = !plain && volume_piece.low > 0.0 && border > f.entry;
    f.entry = at_border ? border : f.entry;
    if (ANTIALIAS == 1u) {
        float wide = filtered.w * footprint_isotropic(filtered_rho2(sight.ray.rho2), Slice(slice.low - z, slice.high - z));
        f.integral = filtered.x > 0.0 ? mix(f.integral, wide, filtered.x) : f.integral;
    }
    vec3 payload = PAYLOAD == PAYLOAD_TAU ? vec3(0.0) : face_payload(sight, f.entry, f.side, f.from_crease, u, ahead, at_border);
    return f.integral * vec4(payload, 1.0);
}

// The splat between `slice`, in the pieces of the ray that clip planes leave: (sum of integrals times payload, their sum).
vec4 clipped_footprint(vec3 p, vec3 u, float ahead, Slice slice) {
    FaceSight sight;
    if (FACES) sight = face_sight(p, u);
    float rho2 = dot(p, p), pn = dot(p, normal_distance.xyz), un = dot(u, normal_distance.xyz);
    Kept kept = kept_pieces(from_eye + params.frame.eye + p, u, -dot(from_eye, u));
    // What begins or ends this far from the voxel does not cut its kernel; a piece that is whole has a closed form.
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
        for (int run = cap ? 1 : 0; run > 0; --run) payload = cap_payload(face, p, u, piece.low);
        Slice cut = Slice(piece.low < -far ? -1e9 : piece.low, piece.high > far ? 1e9 : piece.high);
        cut = Slice(max(cut.low, slice.low), min(cut.high, slice.high));
        if (FACES) {
            vec4 value = vec4(0.0);
            for (int run = cut.low < cut.high ? 1 : 0; run > 0; --run) value = face_value(sight, p, u, ahead, z, cut);
            sum += vec4(cap ? value.a * payload : value.rgb, value.a);
            continue;
        }
        float value = cut.low < cut.high ? drawn_footprint(rho2, pn, un, z, cut) : 0.0;
        sum += value * vec4(payload, 1.0);
    }
    return sum;
}

// (tau * payload, tau) of the ray through p, which is its point nearest to the voxel, relative to it, along u (index space,
// unit); `ahead`: how far along u the eye is before p; `mm`: of a voxel along u.
vec4 splat_value(vec3 p, vec3 u, float ahead, float mm) {
    Slice slice = Slice(-1e9, 1e9);
    float in_front = 1.0;
    if (FOOTPRINTS == TABLE) along_axis = dot(p, selected_footprint.axis);
    if (SLICED == 1u) {
        float depth_along = dot(params.frame.view_z, u);
        vec2 z = (shape.yz - dot(params.frame.view_z, p)) / depth_along;
        slice = Slice(z.x, z.y);
    } else if (CLIP_KEEP + CLIP_REMOVE == 0u) {
        // Only the part of the kernel in front of the eye counts.
        in_front = smoothstep(-params.frame.support, params.frame.support, ahead);
    }
    if (CLIP_KEEP + CLIP_REMOVE > 0u) return color_sigma.a * mm * clipped_footprint(p, u, ahead, slice);
    float z = ANTIALIAS == 1u ? voxel_depth_on_ray(p, u) : 0.0;
    if (FACES) return color_sigma.a * mm * in_front * face_value(face_sight(p, u), p, u, ahead, z, slice);
    float value = drawn_footprint(dot(p, p), dot(p, normal_distance.xyz), dot(u, normal_distance.xyz), z, slice);
    float tau = color_sigma.a * mm * value * in_front;
    return vec4(tau * color_sigma.rgb, tau);
}
#endif

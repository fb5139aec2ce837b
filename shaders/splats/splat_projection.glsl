// Projects a splat's support onto the screen. The including shader declares the uniform block `params.frame` and the
// constants FOOTPRINTS, WARP and ANTIALIAS. The fields of the block are read in place, since a copy of the struct would
// load all of it for every splat.
#ifndef EDGESPLAT_SPLAT_PROJECTION_GLSL
#define EDGESPLAT_SPLAT_PROJECTION_GLSL
#include "shaders/drivers/if_any.glsl"
#include "footprints/in_float.glsl"
#include "engine/geometry/low_pass.glsl"
#include "shaders/edges/edge_record.glsl"
#include "shaders/splats/crease_record.glsl"
#include "shaders/footprints/face_form.glsl"
#include "shaders/shared/footprint_table.h"
#include "shaders/shared/frame_params.h"

struct Projection {
    vec3 position;    // voxel centre relative to the anchor, index space
    vec3 view;        // voxel centre, mm: right, down, forward of the eye
    vec3 centre;      // of the bounding sphere of the support, relative to the voxel centre, index space
    float radius;     // of that sphere, voxels
    LowPass filtered; // only with antialias
    float depth;      // of the support's centre, mm
    vec2 slope;       // view.xy / view.z of the support's centre
    vec2 low, high;   // box of the support in slopes, relative to `slope`
    bool at_eye;      // the support reaches the eye plane: the box is of slopes from the view axis, `slope` is 0
    bool visible;
};

vec3 view_position(vec3 position) {
    return vec3(dot(params.of_volume.view_x, position) + params.of_volume.anchor_x, dot(params.of_volume.view_y, position) + params.of_volume.anchor_y,
                dot(params.of_volume.view_z, position) + params.of_volume.anchor_z);
}

// Whether rays find the splat's face.
bool is_traced(uint number) {
    uvec2 code = BendingsRef(params.of_volume.traits).at[number];
    return (code.x & FACE_CREASED) == 0u && (code.y & FACE_TRACED) != 0u;
}

// Pixels that a voxel covers at a depth (mm), at most.
float pixels_per_voxel(float depth) {
    mat3 m = params.of_volume.index_to_world;
    float longest2 = max(dot(m[0], m[0]), max(dot(m[1], m[1]), dot(m[2], m[2])));
    return sqrt(longest2) * float(params.frame.size.x) / (2.0 * params.frame.tan_half_x * max(depth, params.of_volume.near_depth));
}

// Whether rays find a surface splat's face in this picture: where the error of the fitted face, stored as e.d2, shows.
// `depth`: of the voxel, mm.
bool is_traced_at(uint number, Edge e, float depth) { return is_traced(number) && e.d2 * pixels_per_voxel(depth) > SURFACE_SHOWS; }

// How far in front of their sheets surface splats vote, voxels.
float votes_before() { return SURFACE_REACH + (CREASES == 1u ? SURFACE_CREASE : 0.0); }

// Voxels on both sides of a face carry translucent matter. So its kernels are not moved: the depth is 0.
FaceTraits traits_of(uint number, Edge e, uint material) {
    uvec2 code = BendingsRef(params.of_volume.traits).at[number];
    bool hides = (params.of_volume.translucent_mask >> material & 1u) == 0u;
    FaceTraits t = FaceTraits(Bending(unpack_bending(code.x), unpack_bending(code.y)), no_plane(), NO_PLANE, hides ? FACE_DEPTH : 0.0);
    if (CREASES == 1u) {
        bool creased = (code.x & FACE_CREASED) != 0u;
        if (creased) t.crease = unpack_crease(code);
        t.corner = creased ? unpack_corner(code) : t.corner;
        t.h = Bending(creased ? vec3(0.0) : t.h.diagonal, creased ? vec3(0.0) : t.h.mixed);
    }
    // The table contains plane faces only: slightly bent faces count as plane. It contains no walls.
    bool flat_enough = FOOTPRINTS == TABLE && e.d2 >= params.of_volume.band && bending_norm(t.h) <= TABLE_BENDING && t.crease.away >= CREASE_REACH;
    t.h = Bending(flat_enough ? vec3(0.0) : t.h.diagonal, flat_enough ? vec3(0.0) : t.h.mixed);
    return t;
}

bool is_in_table(uint number, Edge e, uint material) {
    FaceTraits t = traits_of(number, e, material);
    return t.deepest == params.of_volume.table_depth && e.d2 >= params.of_volume.band && bending_norm(t.h) == 0.0 && t.crease.away >= CREASE_REACH;
}

// Bounds of a sphere's perspective image along one screen axis. s = slope of a plane through the eye, relative to the
// centre's slope. The plane touches the sphere if s^2 (z^2 - r^2 |Z|^2) + 2 s r^2 X.Z - r^2 |X|^2 = 0, with X the axis
// functional of slope 0. Relative to the centre nothing cancels, however far the eye.
vec2 touching_slopes(vec3 x_axis, vec3 z_axis, float depth, float radius) {
    float r2 = radius * radius;
    float a = depth * depth - r2 * dot(z_axis, z_axis);
    float b = r2 * dot(x_axis, z_axis);
    float c = r2 * dot(x_axis, x_axis);
    float root = sqrt(b * b + a * c);
    return vec2(-b - root, -b + root) / a;
}

// The same for a support that reaches the eye plane. Seen along the other screen axis it is an ellipse. If the eye is
// inside, every slope meets it; otherwise, the slopes beyond the one tangent that touches it in front of the eye.
vec2 slopes_at_eye(vec3 x_axis, vec3 z_axis, float x, float z, float radius, float edge) {
    float r2 = radius * radius;
    float a = z * z - r2 * dot(z_axis, z_axis);
    float b = x * z - r2 * dot(x_axis, z_axis);
    float c = x * x - r2 * dot(x_axis, x_axis);
    float discriminant = b * b - a * c;
    vec2 range = vec2(-edge, edge);
    if (discriminant <= 0.0 || abs(a) < 1e-12) return range;
    for (int i = 0; i < 2; ++i) {
        float s = (b + (i == 0 ? -1.0 : 1.0) * sqrt(discriminant)) / a;
        vec3 q = x_axis - s * z_axis;
        float side = x - s * z;
        float touching_depth = z - sign(side) * radius * dot(z_axis, q) / length(q);
        if (touching_depth > 0.0 && side > 0.0) range.x = max(range.x, s);
        if (touching_depth > 0.0 && side < 0.0) range.y = min(range.y, s);
    }
    return range;
}

// The widened kernel is centred at the voxel. Splats so near that they may reach the eye are not widened.
void filter_splat(inout Projection p) {
    vec2 pixel = p.view.z * params.frame.pixel;
    vec3 u = normalize(p.position - params.of_volume.eye);
    p.filtered = low_pass(pixel.x * params.of_volume.ray_x, pixel.y * params.of_volume.ray_y, u, params.of_volume.support);
    float around = max(p.radius + length(p.centre), params.of_volume.support);
    if (p.view.z < 2.0 * around * length(params.of_volume.view_z)) p.filtered.share = 0.0;
    p.radius = p.filtered.share > 0.0 ? around : p.radius;
    p.centre = p.filtered.share > 0.0 ? vec3(0.0) : p.centre;
}

// Computes position and support; project_support() computes the position on the screen.
Projection place_splat(uint number, Splat splat, Edge e) {
    Projection p;
    uint nx = uint(params.of_volume.dims.x), ny = uint(params.of_volume.dims.y);
    p.position = vec3(splat.voxel % nx, splat.voxel / nx % ny, splat.voxel / nx / ny) - params.of_volume.anchor;
    p.view = view_position(p.position);
    bool cut_or_warped = FOOTPRINTS != 0u && e.state >= EDGE_LOWER;
    vec2 support = vec2(0.0, cut_or_warped ? params.frame.footprint.paper_reach : params.of_volume.support);
    IF_ANY(FACES && cut_or_warped) {
        FaceTraits traits = traits_of(number, e, splat.edge >> 28);
        if (SURFACES == 1u) {
            bool creased = traits.crease.away < CREASE_REACH;
            support = vec2(creased ? 0.0 : e.d, SURFACE_REACH + (creased ? SURFACE_CREASE : 0.0));
        } else {
            FaceCut cut = cut_of(e, traits, params.of_volume.band, CREASES == 1u);
            support = vec2(cut.shift, cut.radius);
        }
        // Only the ray will find where the surface cuts the kernel.
        if (TRACED == 1u) support = is_traced_at(number, e, p.view.z) ? vec2(0.0, trace_reach(e.d2)) : support;
    }
    p.centre = support.x * e.n;
    p.radius = support.y;
    if (ANTIALIAS == 1u) filter_splat(p);
    return p;
}

// Radius around its centre within which a splat is drawn, across the ray.
float reach_across(Projection p) { return ANTIALIAS == 1u && p.filtered.share > 0.0 ? max(p.radius, p.filtered.reach) : p.radius; }

// Restricts the support to two depths, mm relative to the voxel centre. The part is a cap or a slice of the sphere. It
// lies in the sphere around the circle in which the nearer plane cuts the support.
void cut_support(inout Projection p, vec2 depths) {
    float unit = length(params.of_volume.view_z);
    float middle = dot(params.of_volume.view_z, p.centre);
    float to_slab = clamp(middle, depths.x, depths.y) - middle;
    float gap = min(abs(to_slab) / unit, p.radius);
    p.centre += sign(to_slab) * gap / unit * params.of_volume.view_z;
    p.radius = sqrt(p.radius * p.radius - gap * gap);
}

void project_support(inout Projection p) {
    vec3 centre = view_position(p.position + p.centre);
    p.depth = centre.z;
    float reach = p.radius * length(params.of_volume.view_z);
    float across = reach_across(p);
    p.visible = centre.z + reach > 0.0;
    p.at_eye = centre.z < 1.05 * reach;
    p.slope = p.at_eye ? vec2(0.0) : centre.xy / centre.z;
    vec2 edge = vec2(params.frame.tan_half_x, params.frame.tan_half_y);
    vec2 x, y;
    if (p.at_eye) {
        x = slopes_at_eye(params.of_volume.view_x, params.of_volume.view_z, centre.x, centre.z, p.radius, edge.x);
        y = slopes_at_eye(params.of_volume.view_y, params.of_volume.view_z, centre.y, centre.z, p.radius, edge.y);
    } else {
        x = touching_slopes(params.of_volume.view_x - p.slope.x * params.of_volume.view_z, params.of_volume.view_z, centre.z, across);
        y = touching_slopes(params.of_volume.view_y - p.slope.y * params.of_volume.view_z, params.of_volume.view_z, centre.z, across);
    }
    // A filter wider than its distance covers the whole picture.
    if (ANTIALIAS == 1u && !p.at_eye && centre.z < 1.05 * across * length(params.of_volume.view_z)) x = y = vec2(-1e9, 1e9);
    // Clipped slightly outside the picture, so that rounding loses no pixel.
    p.low = max(vec2(x.x, y.x), -edge * 1.001 - p.slope);
    p.high = min(vec2(x.y, y.y), edge * 1.001 - p.slope);
    p.visible = p.visible && all(lessThan(p.low, p.high));
}

// Points on rays, relative to the voxel, index space. xyz: a point of the ray with slopes (0, 0); w: its depth, mm. The
// ray with slopes (x, y) passes through xyz + w * (x ray_x + y ray_y). The depth is the voxel's, or near_depth if the
// splat may reach the eye.
vec4 rays_beside(Projection p, bool at_eye) {
    vec2 slopes = p.view.xy / p.view.z;
    return at_eye ? vec4(params.of_volume.near_depth * params.of_volume.ray_z - (p.position - params.of_volume.eye), params.of_volume.near_depth)
                  : vec4(-p.view.z * (slopes.x * params.of_volume.ray_x + slopes.y * params.of_volume.ray_y), p.view.z);
}

// The box in pixels: x0 y0 x1 y1, half open, clipped.
ivec4 pixel_box(Projection p) {
    vec2 scale = 0.5 * vec2(params.frame.size) / vec2(params.frame.tan_half_x, params.frame.tan_half_y);
    vec2 low = (p.slope + p.low) * scale + 0.5 * vec2(params.frame.size);
    vec2 high = (p.slope + p.high) * scale + 0.5 * vec2(params.frame.size);
    return ivec4(clamp(ivec2(floor(low)), ivec2(0), params.frame.size), clamp(ivec2(ceil(high)), ivec2(0), params.frame.size));
}
#endif

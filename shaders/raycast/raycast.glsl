// Parts of the ray caster: ray, field, skipping of transparent bricks, light. docs/method.md, Ray caster.
// The including shader declares the uniform block `params`.
#include "shaders/shared/bindings.h"
#include "shaders/shared/raycast_params.h"

layout(constant_id = SPEC_RAY_LIGHT) const uint LIGHT = 1u;
layout(constant_id = SPEC_ISO_COUNT) const uint ISO_COUNT = 1u;
layout(constant_id = SPEC_SKIP) const uint SKIP = 1u;
layout(constant_id = SPEC_RAY_FILTER) const uint FILTER = FILTER_TRILINEAR;
layout(constant_id = SPEC_NO_DATA) const uint NO_DATA = 0u;
const uint LIGHT_NONE = 0u, LIGHT_HEADLIGHT = 1u;

// A new gradient is computed after at least STALE_WAY voxels, once the opacity drawn with the old one exceeds
// STALE_LIGHT.
const float STALE_LIGHT = 1.0 / 64.0, STALE_WAY = 1.0;

layout(binding = BIND_VOLUME, r32f) uniform readonly image3D volume;
layout(binding = BIND_COEFFICIENTS, r32f) uniform readonly image3D coefficients;
layout(binding = BIND_BRICKS, r8ui) uniform readonly uimage3D bricks;

ivec3 dims;
float iso_values[MAX_MATERIALS];
uint visible_mask;

#include "shaders/common/opacity.glsl"
#include "shaders/common/volume_sampling.glsl"
#include "shaders/common/labels.glsl"

// Clamps to the outermost samples.
vec3 within_samples(vec3 p) { return clamp(p, vec3(0.0), vec3(dims - 1)); }

// trilinear() with a cheaper cell (width 0 at the last sample), or the spline, which continues linearly.
float field(vec3 p) {
    if (FILTER == FILTER_CUBIC) return bspline(p);
    p = within_samples(p);
    ivec3 c = ivec3(p);
    return within_cell(c, min(c + 1, dims - 1), p - vec3(c));
}

uint material_of(float value) {
    uint material = 0u;
    for (uint j = 0u; j < ISO_COUNT; ++j) material += iso_values[j] <= value ? 1u : 0u;
    return material;
}

// Whether the voxel nearest to p contains no data.
bool is_missing(vec3 p) { return !has_data(voxel(ivec3(within_samples(p) + 0.5))); }

bool is_visible(uint material) { return (visible_mask >> material & 1u) == 1u; }

// A pixel's ray in index space: origin + t * u. first to last: the part in front of the eye and in the volume. The
// outermost voxels are whole: [-0.5, dim - 0.5].
struct Ray {
    vec3 origin;
    vec3 u;       // unit
    vec3 inverse; // 1 / u
    float first, last;
    float mm;     // millimetres per voxel along the ray
    vec3 border;  // unit normal into the volume if the ray begins at the border; else 0
};

Ray ray_of(ivec2 pixel) {
    vec2 slope = ((vec2(pixel) + 0.5) * 2.0 / vec2(params.rays.size) - 1.0) * vec2(params.rays.tan_half_x, params.rays.tan_half_y);
    Ray ray;
    vec3 way = params.rays.ray_z + slope.x * params.rays.ray_x + slope.y * params.rays.ray_y;
    float per_mm = length(way);
    ray.u = way / per_mm;
    ray.u = mix(ray.u, vec3(1e-8), lessThan(abs(ray.u), vec3(1e-8)));
    ray.inverse = 1.0 / ray.u;
    ray.mm = length(params.rays.index_to_world * ray.u);
    // The origin lies in the plane across the view through the anchor, so that nothing cancels for a far eye.
    vec2 across = slope * params.rays.anchor_z - vec2(params.rays.anchor_x, params.rays.anchor_y);
    ray.origin = params.rays.anchor + across.x * params.rays.ray_x + across.y * params.rays.ray_y;
    float eye = -params.rays.anchor_z * per_mm;
    vec3 a = (vec3(-0.5) - ray.origin) * ray.inverse, b = (vec3(dims) - 0.5 - ray.origin) * ray.inverse;
    vec3 near = min(a, b), far = max(a, b);
    ray.first = max(max(near.x, near.y), max(near.z, eye));
    ray.last = min(far.x, min(far.y, far.z));
    bool y = near.y > near.x, z = near.z > max(near.x, near.y);
    vec3 axis = vec3(!y && !z, y && !z, z);
    ray.border = ray.first > eye ? axis * sign(ray.u) : vec3(0.0);
    return ray;
}

vec3 at(Ray ray, float t) { return ray.origin + t * ray.u; }

// Voxels along the ray from p to the end of the transparent bricks around p; 0 if p's brick is not transparent.
float leap(Ray ray, vec3 p) {
    ivec3 brick = ivec3(clamp(p, vec3(0.0), vec3(dims - 1))) >> BRICK_SHIFT;
    int reach = int(imageLoad(bricks, brick).r);
    vec3 low = vec3((brick - reach + 1) << BRICK_SHIFT), high = vec3((brick + reach) << BRICK_SHIFT);
    vec3 way = (mix(low, high, greaterThan(ray.u, vec3(0.0))) - p) * ray.inverse;
    return reach == 0 ? 0.0 : max(min(way.x, min(way.y, way.z)), 1e-3);
}

// Voxels along the ray from p to the end of its brick.
float leave(Ray ray, vec3 p) {
    ivec3 brick = ivec3(clamp(p, vec3(0.0), vec3(dims - 1))) >> BRICK_SHIFT;
    vec3 low = vec3(brick << BRICK_SHIFT), high = vec3((brick + 1) << BRICK_SHIFT);
    vec3 way = (mix(low, high, greaterThan(ray.u, vec3(0.0))) - p) * ray.inverse;
    return max(min(way.x, min(way.y, way.z)), 0.0);
}

// Interpolated central differences of the voxels around p, clamped so that both ends lie between voxels. Equal to
// differences of six interpolated values, with 32 loads instead of 48. With the spline: its own slope.
vec3 gradient(vec3 p) {
    if (FILTER == FILTER_CUBIC) return bspline_slope(ivec3(0), p).xyz;
    vec3 last = vec3(dims - 1);
    p = clamp(p, min(vec3(1.0), 0.5 * last), max(last - 1.0, 0.5 * last));
    ivec3 c = ivec3(p);
    vec3 t = p - vec3(c);
    ivec3 end = dims - 1;
    ivec3 e = min(c + 1, end), l = max(c - 1, ivec3(0)), h = min(c + 2, end);
    // One row along x each: (y, z) = (c, c), (e, c), (c, e), (e, e).
    vec4 x0 = vec4(voxel(c), voxel(ivec3(c.x, e.y, c.z)), voxel(ivec3(c.x, c.y, e.z)), voxel(ivec3(c.x, e.y, e.z)));
    vec4 x1 = vec4(voxel(ivec3(e.x, c.y, c.z)), voxel(ivec3(e.x, e.y, c.z)), voxel(ivec3(e.x, c.y, e.z)), voxel(e));
    vec4 xl = vec4(voxel(ivec3(l.x, c.y, c.z)), voxel(ivec3(l.x, e.y, c.z)), voxel(ivec3(l.x, c.y, e.z)), voxel(ivec3(l.x, e.y, e.z)));
    vec4 xh = vec4(voxel(ivec3(h.x, c.y, c.z)), voxel(ivec3(h.x, e.y, c.z)), voxel(ivec3(h.x, c.y, e.z)), voxel(ivec3(h.x, e.y, e.z)));
    vec4 gx = mix(x1 - xl, xh - x0, t.x);
    vec4 f = mix(x0, x1, t.x);
    // Below and above along y, at (z) = (c), (e); along z, at (y) = (c), (e).
    vec2 yl = mix(vec2(voxel(ivec3(c.x, l.y, c.z)), voxel(ivec3(c.x, l.y, e.z))), vec2(voxel(ivec3(e.x, l.y, c.z)), voxel(ivec3(e.x, l.y, e.z))), t.x);
    vec2 yh = mix(vec2(voxel(ivec3(c.x, h.y, c.z)), voxel(ivec3(c.x, h.y, e.z))), vec2(voxel(ivec3(e.x, h.y, c.z)), voxel(ivec3(e.x, h.y, e.z))), t.x);
    vec2 zl = mix(vec2(voxel(ivec3(c.xy, l.z)), voxel(ivec3(c.x, e.y, l.z))), vec2(voxel(ivec3(e.x, c.y, l.z)), voxel(ivec3(e.xy, l.z))), t.x);
    vec2 zh = mix(vec2(voxel(ivec3(c.xy, h.z)), voxel(ivec3(c.x, e.y, h.z))), vec2(voxel(ivec3(e.x, c.y, h.z)), voxel(ivec3(e.xy, h.z))), t.x);
    vec2 gy = mix(f.yw - yl, yh - f.xz, t.y);
    vec2 gz = mix(f.zw - zl, zh - f.xy, t.z);
    vec2 g = mix(gx.xz, gx.yw, t.y);
    return 0.5 * vec3(mix(g.x, g.y, t.z), mix(gy.x, gy.y, t.z), mix(gz.x, gz.y, t.y));
}

// Light on a surface with the gradient `g` (index space). If |g| < GRADIENT_MIN, the surface has no direction.
float light_on(vec3 g, vec3 u) {
    vec3 n = normalize(params.rays.normal_to_world * -g);
    vec3 to_light = LIGHT == LIGHT_HEADLIGHT ? -normalize(params.rays.index_to_world * u) : params.rays.light;
    float cosine = dot(g, g) >= GRADIENT_MIN * GRADIENT_MIN ? max(dot(n, to_light), 0.0) : 0.5;
    return params.rays.ambient + params.rays.diffuse * cosine;
}

void read_scene() {
    dims = params.scene.dims;
    visible_mask = params.scene.visible_mask;
    for (uint j = 0u; j < ISO_COUNT; ++j) iso_values[j] = params.scene.iso[j];
}

// The nearest of the eight voxels around p that has the material; the nearest of all if none has.
ivec3 voxel_of(uint material, vec3 p) {
    ivec3 low = ivec3(floor(p)), found = ivec3(round(p));
    float nearest = 1e9;
    for (int i = 0; i < 8; ++i) {
        ivec3 there = min(low + ivec3(i & 1, i >> 1 & 1, i >> 2), dims - 1);
        float away = distance(vec3(there), p);
        bool nearer = away < nearest && material_of(voxel(there)) == material;
        nearest = nearer ? away : nearest;
        found = nearer ? there : found;
    }
    return found;
}

// Unlit colour of a material at p.
vec3 color_at(uint material, vec3 p) {
    vec3 color = params.rays.materials[material].rgb;
    if (LABELS != 0u) {
        vec3 inside = within_samples(p);
        // A surface of a scan has the label of the matter that it bounds.
        ivec3 at = LABELS == LABELS_OF_SCAN ? voxel_of(material, inside) : ivec3(round(inside));
        uint label = material == 0u ? 0u : label_near(at);
        color = label == 0u ? color : ColorsRef(params.rays.label_colors).at[label - 1u];
    }
    return color;
}

void write_pixel(ivec2 pixel, vec4 sum) {
    sum.rgb += (1.0 - sum.a) * params.rays.background;
    PixelsRef(params.rays.pixels).at[pixel.y * params.rays.size.x + pixel.x] = sum;
}

// Eight consecutive invocations cover 4 x 2 pixels, 32 cover 8 x 4: neighbouring pixels take similar paths.
ivec2 pixel_of_invocation() {
    ivec2 i = ivec2(gl_LocalInvocationID.x, gl_LocalInvocationID.y);
    int n = i.x + 8 * i.y;
    return ivec2(gl_WorkGroupID.xy) * 8 + ivec2((n & 3) | (n >> 1 & 4), (n >> 2 & 1) | (n >> 3 & 6));
}

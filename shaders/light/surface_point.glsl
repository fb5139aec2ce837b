// The point where light is evaluated for a splat: on its surface, lifted a little outwards so that the surface does not
// occlude itself. docs/method.md, Light that arrives; mirrored by engine/reference/surface_point.h. The including
// shader declares CLIP_KEEP and CLIP_REMOVE (specialization constants) and CLIP_PARAMS, which contains the planes.
#include "shaders/edges/edge_record.glsl"

const float CUT_REACH = KERNEL_RADIUS;

struct SurfacePoint {
    vec3 foot;     // relative to the voxel centre, index space
    vec3 normal;   // world, unit, outwards; 0 if the splat has none
    vec3 step;     // index space: 1 mm along the normal
    float voxel;   // mm per voxel along the normal
    float room;    // mm along the normal up to the next possible surface
};

bool is_wall(Edge e, float band) { return e.state >= EDGE_LOWER && e.d2 < band; }

// `turned`: use the other face of a wall.
SurfacePoint surface_point(Edge e, float band, bool turned, mat3 normal_to_world) {
    SurfacePoint s = SurfacePoint(vec3(0.0), vec3(0.0), vec3(0.0), 1.0, 0.0);
    if (e.state == EDGE_NONE) return s;
    bool wall = is_wall(e, band);
    float side = (e.state == EDGE_UPPER) == (wall && turned) ? 1.0 : -1.0;  // sign of the outward normal relative to n
    s.normal = normalize(normal_to_world * (side * e.n));
    s.step = transpose(normal_to_world) * s.normal;
    s.voxel = 1.0 / length(s.step);
    s.room = e.state == EDGE_UPPER && !wall ? 0.5 * (e.d + e.d2) * s.voxel : 1e9;
    // The record does not store edges further away than the kernel's width. Such a splat uses the voxel centre.
    if (e.state >= EDGE_LOWER) s.foot = (wall && side < 0.0 ? -e.d2 : e.d) * e.n;
    return s;
}

// If a clip plane cuts the kernel and is nearer to the voxel than the splat's own edge, the cut is the surface.
// `position`: in the coordinates of the planes.
SurfacePoint at_cut(SurfacePoint s, Edge e, vec3 position, mat3 normal_to_world) {
    float keep = -1e9, remove = -1e9;
    vec3 keep_normal = vec3(0.0), remove_normal = vec3(0.0);
    for (uint i = 0u; i < CLIP_KEEP; ++i) {
        vec4 plane = CLIP_PARAMS.clip_keep[i];
        float d = dot(plane, vec4(position, 1.0));
        keep_normal = d > keep ? plane.xyz : keep_normal;
        keep = max(keep, d);
    }
    for (uint i = 0u; i < CLIP_REMOVE; ++i) {
        vec4 plane = CLIP_PARAMS.clip_remove[i];
        float d = dot(plane, vec4(position, 1.0));
        remove_normal = d > remove ? plane.xyz : remove_normal;
        remove = max(remove, d);
    }
    bool hole = abs(remove) < abs(keep);
    float d = hole ? remove : keep;
    vec3 normal = hole ? remove_normal : keep_normal;
    float own = e.state >= EDGE_LOWER ? min(abs(e.d), abs(e.d2)) : 1e9;
    if (abs(d) >= min(own, CUT_REACH)) return s;
    s.foot = -d * normal;
    s.normal = normalize(normal_to_world * (hole ? -normal : normal));
    s.step = transpose(normal_to_world) * s.normal;
    s.voxel = 1.0 / length(s.step);
    s.room = 1e9;
    return s;
}

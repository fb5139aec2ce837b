// Where light arrives at a splat: at the surface that it shows, a little outside of it, so that the surface is not in its own
// way. docs/method.md, Light that arrives; mirrored by engine/reference/surface_point.h. The including shader declares
// CLIP_KEEP and CLIP_REMOVE (specialization constants) and CLIP_PARAMS, which holds the planes.
#include "shaders/edges/edge_record.glsl"

const float SHORTEST_LIFT = 1.5;  // voxels between a surface and the place that looks up from it

const float CUT_REACH = KERNEL_RADIUS;

struct SurfacePoint {
    vec3 foot;     // relative to the voxel centre, index space
    vec3 normal;   // world, unit, outwards; 0 where the splat has none
    vec3 step;     // index space: one mm along the normal
    float voxel;   // mm per voxel along the normal
    float room;    // mm along the normal to where the next surface may be
};

bool is_wall(Edge e, float band) { return e.state >= EDGE_LOWER && e.d2 < band; }

// `turned`: of a wall, the face on the other side.
SurfacePoint surface_point(Edge e, float band, bool turned, mat3 normal_to_world) {
    SurfacePoint s = SurfacePoint(vec3(0.0), vec3(0.0), vec3(0.0), 1.0, 0.0);
    if (e.state == EDGE_NONE) return s;
    bool wall = is_wall(e, band);
    float side = (e.state == EDGE_UPPER) == (wall && turned) ? 1.0 : -1.0;  // of the outward normal along n
    s.normal = normalize(normal_to_world * (side * e.n));
    s.step = transpose(normal_to_world) * s.normal;
    s.voxel = 1.0 / length(s.step);
    s.room = e.state == EDGE_UPPER && !wall ? 0.5 * (e.d + e.d2) * s.voxel : 1e9;
    // An edge further off than the kernel is wide is not in the record: such a splat shows its own place.
    if (e.state >= EDGE_LOWER) s.foot = (wall && side < 0.0 ? -e.d2 : e.d) * e.n;
    return s;
}

// Where a clip plane is nearer to the voxel than the splat's own edge and cuts its kernel, the cut is the surface. `position` is
// counted from where the planes are.
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

// The point where light is evaluated for a splat: on its surface, lifted a little outwards so that the surface does not
// occlude itself. docs/method/light.md. Written in the subset of GLSL that is C++. The includer declares the clip planes of
// the kept and of the removed region, CLIP_KEEP and CLIP_REMOVE of them: keep_plane(uint) and remove_plane(uint), normal and
// offset. Include after edge.glsl.
#ifndef EDGESPLAT_SURFACE_POINT_GLSL
#define EDGESPLAT_SURFACE_POINT_GLSL

struct SurfacePoint {
    vec3 foot;    // relative to the voxel centre, index space
    vec3 normal;  // world, unit, outwards; 0 if the splat has none
    vec3 step;    // index space: 1 mm along the normal
    Real voxel;   // mm per voxel along the normal
    Real room;    // mm along the normal up to the next possible surface
};

bool is_wall(Edge e, Real band) { return e.state >= EDGE_LOWER && e.d2 < band; }

// The surface whose normal is n, index space.
SurfacePoint surface_with_normal(vec3 foot, vec3 n, mat3 normal_to_world) {
    SurfacePoint s;
    s.foot = foot;
    s.normal = normalize(normal_to_world * n);
    s.step = transpose(normal_to_world) * s.normal;
    s.voxel = 1.0 / length(s.step);
    s.room = 1e9;
    return s;
}

// `turned`: use the other face of a wall.
SurfacePoint surface_point(Edge e, Real band, bool turned, mat3 normal_to_world) {
    SurfacePoint none = {vec3(0.0), vec3(0.0), vec3(0.0), 1.0, 0.0};
    if (e.state == EDGE_NONE) return none;
    bool wall = is_wall(e, band);
    Real side = (e.state == EDGE_UPPER) == (wall && turned) ? 1.0 : -1.0;  // sign of the outward normal relative to n
    SurfacePoint s = surface_with_normal(vec3(0.0), side * e.n, normal_to_world);
    if (e.state == EDGE_UPPER && !wall) s.room = 0.5 * (e.d + e.d2) * s.voxel;
    // The record does not store edges further away than the kernel's width. Such a splat uses the voxel centre.
    if (e.state >= EDGE_LOWER) s.foot = (wall && side < 0.0 ? -e.d2 : e.d) * e.n;
    return s;
}

// If a clip plane cuts the kernel and is nearer to the voxel than the splat's own edge, the cut is the surface.
// `position`: in the coordinates of the planes.
SurfacePoint at_cut(SurfacePoint s, Edge e, vec3 position, mat3 normal_to_world) {
    Real keep = -1e9;
    Real remove = -1e9;
    vec3 keep_normal = vec3(0.0);
    vec3 remove_normal = vec3(0.0);
    for (uint i = 0u; i < CLIP_KEEP; ++i) {
        vec4 plane = keep_plane(i);
        Real d = dot(plane, vec4(position, 1.0));
        keep_normal = d > keep ? vec3(plane) : keep_normal;
        keep = max(keep, d);
    }
    for (uint i = 0u; i < CLIP_REMOVE; ++i) {
        vec4 plane = remove_plane(i);
        Real d = dot(plane, vec4(position, 1.0));
        remove_normal = d > remove ? vec3(plane) : remove_normal;
        remove = max(remove, d);
    }
    bool hole = abs(remove) < abs(keep);
    Real d = hole ? remove : keep;
    vec3 normal = hole ? remove_normal : keep_normal;
    Real own = e.state >= EDGE_LOWER ? min(abs(e.d), abs(e.d2)) : Real(1e9);
    if (abs(d) >= min(own, KERNEL_RADIUS)) return s;
    return surface_with_normal(-d * normal, hole ? -normal : normal, normal_to_world);
}
#endif

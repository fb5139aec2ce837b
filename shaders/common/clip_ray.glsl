// The pieces of a ray that clip planes keep. Include after the declarations that shaders/common/clip.glsl
// names, and after shaders/footprints/slice.glsl.
#ifndef EDGESPLAT_CLIP_RAY_GLSL
#define EDGESPLAT_CLIP_RAY_GLSL

// z is measured along the ray from the given point. A face is the normal of the cut where the piece begins (index
// space, towards the side that is cut away); 0 if the piece does not begin at a cut.
struct Kept {
    Slice before;  // the piece before the one that `remove` cuts out; the whole ray if it cuts out none
    Slice behind;
    vec3 before_face;
    vec3 behind_face;
};

const float CLIP_PARALLEL = 1e-6;  // |n.u| below this: the ray is parallel to the plane

// The kept pieces of the ray through `place` along u, from z = `eye` on.
Kept kept_pieces(vec3 place, vec3 u, float eye) {
    Kept kept = Kept(Slice(eye, 1e9), Slice(1e9, 1e9), vec3(0.0), vec3(0.0));
    for (uint i = 0u; i < CLIP_KEEP; ++i) {
        vec4 plane = CLIP_PARAMS.clip_keep[i];
        float along = dot(plane.xyz, u);
        along = along < 0.0 ? min(along, -CLIP_PARALLEL) : max(along, CLIP_PARALLEL);
        float z = -dot(plane, vec4(place, 1.0)) / along;
        bool entered = along < 0.0 && z > kept.before.low;
        kept.before_face = entered ? plane.xyz : kept.before_face;
        kept.before.low = entered ? z : kept.before.low;
        kept.before.high = along > 0.0 ? min(kept.before.high, z) : kept.before.high;
    }
    if (CLIP_REMOVE > 0u) {
        Slice gone = Slice(-1e9, 1e9);
        vec3 face = vec3(0.0);
        for (uint i = 0u; i < CLIP_REMOVE; ++i) {
            vec4 plane = CLIP_PARAMS.clip_remove[i];
            float along = dot(plane.xyz, u);
            along = along < 0.0 ? min(along, -CLIP_PARALLEL) : max(along, CLIP_PARALLEL);
            float z = -dot(plane, vec4(place, 1.0)) / along;
            bool left = along > 0.0 && z < gone.high;
            face = left ? -plane.xyz : face;
            gone.high = left ? z : gone.high;
            gone.low = along < 0.0 ? max(gone.low, z) : gone.low;
        }
        bool some = gone.low < gone.high;
        bool later = gone.high > kept.before.low;
        kept.behind = some ? Slice(later ? gone.high : kept.before.low, kept.before.high) : kept.behind;
        kept.behind_face = later ? face : kept.before_face;
        kept.before.high = some ? min(kept.before.high, gone.low) : kept.before.high;
    }
    return kept;
}
#endif

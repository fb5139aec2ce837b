// The parts of a pixel's ray that lie in the volume and that clip planes keep. Matter may begin at their ends, where no
// surface is. Include after shaders/common/clip_ray.glsl and engine/geometry/volume_ends.glsl.

// Distances from the eye, voxels; empty if first >= last. n: normal of the border or the plane where the part begins,
// index space, away from the part; 0: it begins at the eye.
struct RayPart {
    float first, last;
    vec3 n;
};

// `behind`: behind what the planes of `remove` cut out.
struct RayParts {
    RayPart before, behind;
};

RayPart kept_part(RayPart whole, Slice kept, vec3 face) {
    return RayPart(max(whole.first, kept.low), min(whole.last, kept.high), kept.low > whole.first ? face : whole.n);
}

// A face that a ray enters just before the part, within the error of faces, is seen where the part begins. n: its normal.
bool enters_just_before(RayPart part, float way, vec3 n, vec3 u) {
    float before = part.first - way;
    return part.n != vec3(0.0) && before > 0.0 && before < SURFACE_EARLY && before * abs(dot(n, u)) < SURFACE_SIDE * length(n);
}

bool is_in_part(RayPart part, float way) { return way >= part.first - 1e-3 && way <= part.last; }

RayParts ray_parts(vec3 u) {
    VolumeEnds ends = volume_ends(params.of_volume.anchor + params.of_volume.eye, divisible(u), params.of_volume.dims);
    float first = entry_of(ends);
    RayPart whole = RayPart(max(first, 0.0), exit_of(ends), first > 0.0 ? out_of_entry(ends, u) : vec3(0.0));
    RayParts parts = RayParts(whole, RayPart(1e9, -1e9, vec3(0.0)));
    if (CLIP_KEEP + CLIP_REMOVE > 0u) {
        Kept kept = kept_pieces(params.of_volume.eye, u, 0.0);
        parts.before = kept_part(whole, kept.before, kept.before_face);
        if (CLIP_REMOVE > 0u) parts.behind = kept_part(whole, kept.behind, kept.behind_face);
    }
    return parts;
}

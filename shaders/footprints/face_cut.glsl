// How a face cuts a kernel, independent of the ray: the float32 mirror of face_cut() in footprints/face.h. Include
// after shaders/footprints/kernel.glsl. Written in the subset of GLSL that is also C++.
#ifndef EDGESPLAT_FACE_CUT_GLSL
#define EDGESPLAT_FACE_CUT_GLSL

const float FACE_DEPTH = 0.8;     // kFaceDepth: of opaque matter
const float FACE_FARTHEST = 3.0;  // kFaceFarthest: upper bound of every kernel's reach
const float FACE_NO_WALL = 1e8;  // the thickness is larger if no second face lies behind the first

struct FaceCut {
    float depth;
    float thickness;
    float reach2;
    float shift;   // along the normal to the centre of a sphere that contains the kernel
    float radius;
};

struct FaceReach {
    float reach2;  // 0: no larger than the plain kernel's
    float along;
};

FaceReach face_reach(float distance, float depth, float norm) {
    float off = distance - depth;
    float spread = 1.0 + 1.2 * depth * norm;
    float lateral2 = max(KERNEL_R2 - off * off, 0.0) * spread * spread;
    FaceReach r;
    r.along = max(distance, 0.0) + 0.5 * norm * lateral2;
    r.reach2 = abs(off) < KERNEL_R ? lateral2 + r.along * r.along : 0.0;
    return r;
}

// `deepest`: upper bound of FaceCut::depth.
FaceCut face_cut(float distance, float bend, float norm, float thickness, float deepest) {
    FaceCut cut;
    cut.thickness = thickness;
    cut.depth = min(min(deepest, 0.5 / max(bend, 1e-3)), 0.5 * thickness);
    bool wall = thickness < FACE_NO_WALL;
    FaceReach face = face_reach(distance, cut.depth, norm);
    float other = wall ? face_reach(thickness - distance, cut.depth, norm).reach2 : 0.0;
    float most = KERNEL_R + cut.depth;
    cut.reach2 = min(max(KERNEL_R2, max(face.reach2, other)), most * most);
    // The sphere through the rim of the moved points that also contains the plain kernel.
    float shift = max(face.reach2 - KERNEL_R2, 0.0) / (2.0 * (face.along + KERNEL_R));
    bool shifted = !wall && KERNEL_R + shift < most;
    cut.shift = shifted ? shift : 0.0;
    cut.radius = shifted ? KERNEL_R + shift : sqrt(cut.reach2);
    return cut;
}

// Another plane that bounds the matter, at a crease, relative to a ray. Mirrors FaceRay::Crease and FaceCut::Crease.
struct FaceCrease {
    float p;         // n . p
    float u;         // n . u
    float distance;  // from the voxel's centre; larger than FACE_NO_WALL if there is no plane
    float facing;    // cosine of its normal with the face's
    // A third plane that bounds the matter, at a corner.
    float corner_p;
    float corner_u;
    float corner_distance;
};

// Enlarges the reach by the amount that the crease's plane adds.
FaceCut with_crease(FaceCut cut, float distance) {
    float further = distance < KERNEL_R + cut.depth ? max((2.0 * distance - cut.depth) * cut.depth, 0.0) : 0.0;
    cut.reach2 = min(cut.reach2 + further, FACE_FARTHEST * FACE_FARTHEST);
    cut.shift = further > 0.0 ? 0.0 : cut.shift;
    cut.radius = further > 0.0 ? sqrt(cut.reach2) : cut.radius;
    return cut;
}
#endif

// How a face cuts a kernel, whatever the ray: the float32 mirror of face_cut() in footprints/face.h. After
// shaders/footprints/kernel.glsl, in the subset of GLSL that is C++ too.
#ifndef EDGESPLAT_FACE_CUT_GLSL
#define EDGESPLAT_FACE_CUT_GLSL

const float FACE_DEPTH = 0.8;     // kFaceDepth: of matter that hides what is behind
const float FACE_FARTHEST = 3.0;  // kFaceFarthest: no kernel reaches further
const float FACE_NO_WALL = 1e8;  // a face without another behind it has a larger thickness

struct FaceCut {
    float depth;
    float thickness;
    float reach2;
    float shift;   // along the normal to the centre of a sphere that holds the kernel
    float radius;
};

struct FaceReach {
    float reach2;  // 0: no further than the plain kernel
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

// `deepest`: as FaceCut::depth, at most.
FaceCut face_cut(float distance, float bend, float norm, float thickness, float deepest) {
    FaceCut cut;
    cut.thickness = thickness;
    cut.depth = min(min(deepest, 0.5 / max(bend, 1e-3)), 0.5 * thickness);
    bool wall = thickness < FACE_NO_WALL;
    FaceReach face = face_reach(distance, cut.depth, norm);
    float other = wall ? face_reach(thickness - distance, cut.depth, norm).reach2 : 0.0;
    float most = KERNEL_R + cut.depth;
    cut.reach2 = min(max(KERNEL_R2, max(face.reach2, other)), most * most);
    // The sphere through the rim of what is moved that holds the plain kernel, too.
    float shift = max(face.reach2 - KERNEL_R2, 0.0) / (2.0 * (face.along + KERNEL_R));
    bool shifted = !wall && KERNEL_R + shift < most;
    cut.shift = shifted ? shift : 0.0;
    cut.radius = shifted ? KERNEL_R + shift : sqrt(cut.reach2);
    return cut;
}

// Another plane that ends the matter, at a crease, as a ray sees it; mirrors FaceRay::Crease and FaceCut::Crease.
struct FaceCrease {
    float p;         // n . p
    float u;         // n . u
    float distance;  // from the voxel's centre; beyond FACE_NO_WALL there is none
    float facing;    // cosine of its normal with the face's
    // Of a third plane, at a corner, which ends the matter, too.
    float corner_p;
    float corner_u;
    float corner_distance;
};

// By as much as it lets the kernel reach further.
FaceCut with_crease(FaceCut cut, float distance) {
    float further = distance < KERNEL_R + cut.depth ? max((2.0 * distance - cut.depth) * cut.depth, 0.0) : 0.0;
    cut.reach2 = min(cut.reach2 + further, FACE_FARTHEST * FACE_FARTHEST);
    cut.shift = further > 0.0 ? 0.0 : cut.shift;
    cut.radius = further > 0.0 ? sqrt(cut.reach2) : cut.radius;
    return cut;
}
#endif

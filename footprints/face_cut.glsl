// How a face cuts a kernel, independent of the ray. Written in the subset of GLSL that is C++. The includer declares the
// kernel: KERNEL_R, KERNEL_R2, KERNEL_INVERSE_R2 and kernel_at(1 - r^2 / R^2). Include after face_types.glsl.
#ifndef EDGESPLAT_FACE_CUT_GLSL
#define EDGESPLAT_FACE_CUT_GLSL

struct FaceReach {
    Real reach2;  // 0: no larger than the plain kernel's
    Real along;
};

FaceReach face_reach(Real distance, Real depth, Real norm) {
    Real off = distance - depth;
    // Normals turn by `norm` per voxel, which spreads the points that are moved along them; and the face leaves its tangent
    // plane.
    Real spread = 1.0 + 1.2 * depth * norm;
    Real lateral2 = max(KERNEL_R2 - off * off, 0.0) * spread * spread;
    FaceReach r;
    r.along = max(distance, 0.0) + 0.5 * norm * lateral2;
    r.reach2 = abs(off) < KERNEL_R ? lateral2 + r.along * r.along : 0.0;
    return r;
}

// Of a face whose foot point lies `distance` from the voxel's centre. `bend`: n'Hn there; `norm`: the Frobenius norm of H,
// 1/voxel; `deepest`: upper bound of FaceCut::depth.
FaceCut face_cut(Real distance, Real bend, Real norm, Real thickness, Real deepest) {
    FaceCut cut;
    cut.thickness = thickness;
    // If the face bends away on both sides, the ridge, where the slope is 0, limits the depth.
    cut.depth = min(min(deepest, 0.5 / max(bend, 1e-3)), 0.5 * thickness);
    bool wall = thickness < FACE_NO_WALL;
    FaceReach face = face_reach(distance, cut.depth, norm);
    Real other = wall ? face_reach(thickness - distance, cut.depth, norm).reach2 : 0.0;
    Real most = KERNEL_R + cut.depth;  // no point is moved by more than the depth
    cut.reach2 = min(max(KERNEL_R2, max(face.reach2, other)), most * most);
    // The sphere through the rim of the moved points that also contains the plain kernel.
    Real shift = max(face.reach2 - KERNEL_R2, 0.0) / (2.0 * (face.along + KERNEL_R));
    bool shifted = !wall && KERNEL_R + shift < most;
    cut.shift = shifted ? shift : 0.0;
    cut.radius = shifted ? KERNEL_R + shift : sqrt(cut.reach2);
    return cut;
}

// Enlarges the reach by the amount that a crease's plane adds: points that both moves bring into the kernel may come from
// further. Its bound costs translucent edges a little of their outermost matter.
FaceCut with_crease(FaceCut cut, Real distance) {
    Real further = distance < KERNEL_R + cut.depth ? max((2.0 * distance - cut.depth) * cut.depth, 0.0) : 0.0;
    cut.reach2 = min(cut.reach2 + further, FACE_FARTHEST * FACE_FARTHEST);
    cut.shift = further > 0.0 ? 0.0 : cut.shift;
    cut.radius = further > 0.0 ? sqrt(cut.reach2) : cut.radius;
    return cut;
}
#endif

// A splat's face, as it is drawn. docs/method/faces.md. Written in the subset of GLSL that is C++. Include after edge.glsl,
// footprints/face_types.glsl and footprints/face_cut.glsl.
#ifndef EDGESPLAT_GEOMETRY_FACE_FORM_GLSL
#define EDGESPLAT_GEOMETRY_FACE_FORM_GLSL

// Properties of a face besides its normal and distance.
struct FaceTraits {
    Bending h;
    Plane crease;  // another plane that cuts the kernel
    Real corner;   // of a third plane, as Face::corner
    Real deepest;  // the kernel is sampled at most this deep under the face, voxels
};

// A face and how it cuts the kernel, or a plain kernel with the normal that it is lit by.
struct FaceForm {
    Real value;  // phi at the voxel's centre
    vec3 slope;  // the gradient of phi there
    Bending h;
    FaceCut cut;  // depth < 0: the kernel is plain
    Plane crease;
    Real corner;
};

// How the face cuts its kernel. `band`: a second face beyond cuts nothing; `creases`: whether the scene has any. Planes of
// a crease that cut nothing are removed; a corner's plane is the furthest of the three.
FaceCut cut_of(Edge e, INOUT(FaceTraits) t, Real band, bool creases) {
    Real thickness = e.d2 < band ? max(e.d + e.d2, 0.05) : FACE_NOWHERE;
    FaceCut cut = face_cut(e.d, dot(e.n, bent(t.h, e.n)), bending_norm(t.h), thickness, t.deepest);
    if (creases) {
        bool cuts = t.crease.away < KERNEL_R + cut.depth;
        if (!cuts) t.crease = no_plane();
        if (!cuts) t.corner = NO_PLANE;
        cut = with_crease(cut, t.crease.away);
    }
    return cut;
}

FaceForm face_form_of(Edge e, FaceTraits t, FaceCut cut) {
    vec3 at_foot = bent(t.h, e.d * e.n);
    FaceForm form = {-e.d + 0.5 * e.d * dot(e.n, at_foot), e.n - at_foot, t.h, cut, t.crease, t.corner};
    return form;
}

// A plain kernel, with the normal n or 0.
FaceForm plain_form(vec3 n) {
    FaceForm form;
    form.value = 0.0;
    form.slope = n;
    form.h = no_bending();
    form.cut.depth = -1.0;
    form.cut.thickness = FACE_NOWHERE;
    form.cut.reach2 = KERNEL_R2;
    form.cut.shift = 0.0;
    form.cut.radius = 0.0;
    form.crease = no_plane();
    form.corner = NO_PLANE;
    return form;
}
#endif

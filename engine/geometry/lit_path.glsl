// Where light falls on a splat of translucent matter: at both ends of the ray's path through it (docs/method/shading.md).
// Written in the subset of GLSL that is C++.
#ifndef EDGESPLAT_LIT_PATH_GLSL
#define EDGESPLAT_LIT_PATH_GLSL

// Positions on the ray from its point nearest to the voxel, voxels.
struct LitPath {
    Real near;
    Real far;
    bool to_border;  // the far end lies on the volume's border
    Real share;      // weight of the far end: the farther half's share of the absorption
};

// The piece between the two faces of a layer between two iso-values, if the ray meets both nearby; else near and far, which
// lie between them. Between the faces the field is monotonic, but the quadric with both as level sets turns.
vec2 way_between_faces(Quadratic phi, Real near, Real far) {
    Real root2 = phi.b * phi.b - 4.0 * phi.a * phi.c;
    Real sum = -0.5 * (phi.b + (phi.b < 0.0 ? -1.0 : 1.0) * sqrt(max(root2, Real(0.0))));
    Real one = sum / not_zero(phi.a);
    Real other = phi.c / not_zero(sum);
    Real low = min(one, other);
    Real high = max(one, other);
    bool both = root2 > 0.0 && low > -LIT_FACES && high < LIT_FACES;
    return both ? vec2(min(near, low), max(far, high)) : vec2(near, far);
}

// `entry`, `leave`: where the ray enters and leaves the kernel's matter; `at_border`: it enters at the border.
// `far_border`: where it leaves the volume. `half_chord`: half its way through the kernel. `absorbs`: optical depth per voxel.
// `layer`: this matter lies between two iso-values. phi: its quadric along the ray.
LitPath lit_path(Real entry, Real leave, bool at_border, Real far_border, Real half_chord, Real absorbs, bool layer, Quadratic phi) {
    Real most = LIT_WITHIN * half_chord;  // most of the kernel
    LitPath path;
    path.to_border = far_border < leave;
    path.far = max(min(path.to_border ? far_border : leave, most), entry);
    path.near = at_border ? entry : min(max(entry, -most), path.far);
    path.share = 1.0 / (1.0 + exp(0.5 * absorbs * (path.far - path.near)));
    if (layer) {
        vec2 way = way_between_faces(phi, path.near, path.far);
        path.near = at_border ? path.near : way.x;
        path.far = path.to_border ? path.far : way.y;
    }
    return path;
}
#endif

// A face's second derivatives, and planes. Written in the subset of GLSL that is C++: shaders include it after
// in_float.glsl, C++ through in_double.h.
#ifndef EDGESPLAT_BENDING_GLSL
#define EDGESPLAT_BENDING_GLSL

// Symmetric matrix: xx yy zz, yz xz xy; 1/voxel.
struct Bending {
    vec3 diagonal;
    vec3 mixed;
};

Bending no_bending() {
    Bending h = {vec3(0.0), vec3(0.0)};
    return h;
}

vec3 bent(Bending h, vec3 v) {
    return vec3(h.diagonal.x * v.x + h.mixed.z * v.y + h.mixed.y * v.z, h.mixed.z * v.x + h.diagonal.y * v.y + h.mixed.x * v.z,
                h.mixed.y * v.x + h.mixed.x * v.y + h.diagonal.z * v.z);
}

Bending scaled(Bending h, Real factor) {
    Bending result = {factor * h.diagonal, factor * h.mixed};
    return result;
}

Real bending_norm(Bending h) { return sqrt(dot(h.diagonal, h.diagonal) + 2.0 * dot(h.mixed, h.mixed)); }

// The larger of the two principal curvatures, valid if H n is small. Outward bending is positive.
Real largest_bend(Bending h) {
    Real norm = bending_norm(h);
    Real sum = h.diagonal.x + h.diagonal.y + h.diagonal.z;
    return 0.5 * (sum + sqrt(max(2.0 * norm * norm - sum * sum, 0.0)));
}

// Of the products a b', those at the places of Bending::mixed.
vec3 mixed_products(vec3 a, vec3 b) { return vec3(a.y * b.z, a.x * b.z, a.x * b.y); }

// Moves the component of H n perpendicular to n towards `turn`, by a share. This is how far the slope turns over a
// voxel along n. On the face itself the change is of third order.
Bending turned_along(Bending h, vec3 n, vec3 turn, Real share) {
    vec3 change = share * (turn - bent(h, n));
    change -= dot(change, n) * n;
    Bending result = {h.diagonal + 2.0 * n * change, h.mixed + mixed_products(n, change) + mixed_products(change, n)};
    return result;
}

// A plane n.x = away that bounds matter, n out of it. `away` is NO_PLANE if there is none.
struct Plane {
    vec3 n;
    Real away;
};

const Real NO_PLANE = 1e9;

Plane no_plane() {
    Plane plane = {vec3(0.0, 0.0, 1.0), NO_PLANE};
    return plane;
}
#endif

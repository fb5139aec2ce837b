// Fits a quadric to points of a surface and their normals. docs/method.md, Faces, 2; mirrored by
// engine/reference/quadrics.h.
#ifndef EDGESPLAT_QUADRIC_GLSL
#define EDGESPLAT_QUADRIC_GLSL
#include "shaders/footprints/face_record.glsl"

// Weighted sums over surfels at r with normals m.
struct Moments {
    float weight;
    vec3 r, m;
    vec3 squares, products;  // of r: xx yy zz, yz xz xy
    mat3 turns;              // m r'
};

Moments no_moments() { return Moments(0.0, vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), mat3(0.0)); }

void add_surfel(inout Moments sums, vec3 r, vec3 m, float w) {
    sums.weight += w;
    sums.r += w * r;
    sums.m += w * m;
    sums.squares += w * r * r;
    sums.products += w * r.yxx * r.zzy;
    sums.turns += outerProduct(w * m, r);
}

struct Quadric {
    float c;
    vec3 g;
    Bending h;
};

float quadric_at(Quadric q, vec3 r) { return q.c + dot(q.g, r) + 0.5 * dot(r, bent(q.h, r)); }
vec3 quadric_slope(Quadric q, vec3 r) { return q.g + bent(q.h, r); }

// One Jacobi rotation: pq becomes 0.
void rotate(inout float pp, inout float qq, inout float pq, inout float rp, inout float rq, inout vec3 p, inout vec3 q) {
    float theta = (qq - pp) * 0.5;
    float t = pq / (abs(theta) + sqrt(theta * theta + pq * pq) + 1e-30) * (theta < 0.0 ? -1.0 : 1.0);
    float c = inversesqrt(t * t + 1.0), s = t * c;
    pp -= t * pq;
    qq += t * pq;
    pq = 0.0;
    float old_rp = rp;
    rp = c * rp - s * rq;
    rq = s * old_rp + c * rq;
    vec3 old_p = p;
    p = c * p - s * q;
    q = s * old_p + c * q;
}

// The normals of a quadric are linear in position. H is the symmetric matrix that fits them best: it solves H C + C H =
// D + D', with C the covariance of positions and D that of normals with positions. g follows from H; c follows because
// the points lie on the surface.
Quadric quadric_of(Moments sums) {
    float share = 1.0 / max(sums.weight, 1e-20);
    vec3 r = share * sums.r, m = share * sums.m, squares = share * sums.squares, products = share * sums.products;
    vec3 own = squares - r * r, mixed = products - r.yxx * r.zzy;
    mat3 turns = share * sums.turns - outerProduct(m, r);
    mat3 both = turns + transpose(turns);
    mat3 axes = mat3(1.0);
    for (int sweep = 0; sweep < 4; ++sweep) {
        rotate(own.x, own.y, mixed.z, mixed.y, mixed.x, axes[0], axes[1]);
        rotate(own.x, own.z, mixed.y, mixed.z, mixed.x, axes[0], axes[2]);
        rotate(own.y, own.z, mixed.x, mixed.z, mixed.y, axes[1], axes[2]);
    }
    mat3 turned = transpose(axes) * both * axes;
    own = max(own, vec3(0.0)) + FIT_RIDGE;
    for (int i = 0; i < 3; ++i) turned[i] /= own + own[i];
    mat3 h = axes * turned * transpose(axes);
    Quadric q;
    q.h = Bending(vec3(h[0][0], h[1][1], h[2][2]), vec3(h[1][2], h[0][2], h[0][1]));
    q.g = m - bent(q.h, r);
    q.c = -dot(q.g, r) - 0.5 * dot(q.h.diagonal, squares) - dot(q.h.mixed, products);
    return q;
}
#endif

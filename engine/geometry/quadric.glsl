// Fits a quadric to points of a surface and their normals. docs/method/faces.md, 2. Written in the subset of GLSL that is
// C++. Include after bending.glsl.
#ifndef EDGESPLAT_QUADRIC_GLSL
#define EDGESPLAT_QUADRIC_GLSL

// Weighted sums over surfels at r with normals m.
struct Moments {
    Real weight;
    vec3 r;
    vec3 m;
    vec3 squares;   // of r: xx yy zz
    vec3 products;  // yz xz xy
    mat3 turns;     // m r'
};

Moments no_moments() {
    Moments sums = {0.0, vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), mat3(0.0)};
    return sums;
}

void add_surfel(INOUT(Moments) sums, vec3 r, vec3 m, Real w) {
    sums.weight += w;
    sums.r += w * r;
    sums.m += w * m;
    sums.squares += w * r * r;
    sums.products += mixed_products(w * r, r);
    sums.turns += outerProduct(w * m, r);
}

// c + g.x + x'Hx / 2.
struct Quadric {
    Real c;
    vec3 g;
    Bending h;
};

Real quadric_at(Quadric q, vec3 r) { return q.c + dot(q.g, r) + 0.5 * dot(r, bent(q.h, r)); }
vec3 quadric_slope(Quadric q, vec3 r) { return q.g + bent(q.h, r); }

// The same quadric around another point.
Quadric quadric_about(Quadric q, vec3 m) {
    Quadric moved = {quadric_at(q, m), quadric_slope(q, m), q.h};
    return moved;
}

// Distance of a point from a quadric, to first order.
Real quadric_off(Quadric q, vec3 r) { return quadric_at(q, r) / max(length(quadric_slope(q, r)), 0.2); }

// One Jacobi rotation: pq becomes 0.
void rotate(INOUT(Real) pp, INOUT(Real) qq, INOUT(Real) pq, INOUT(Real) rp, INOUT(Real) rq, INOUT(vec3) p, INOUT(vec3) q) {
    Real theta = (qq - pp) * 0.5;
    Real t = pq / (abs(theta) + sqrt(theta * theta + pq * pq) + 1e-30) * (theta < 0.0 ? -1.0 : 1.0);
    Real c = inversesqrt(t * t + 1.0);
    Real s = t * c;
    pp -= t * pq;
    qq += t * pq;
    pq = 0.0;
    Real old_rp = rp;
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
    Real share = 1.0 / max(sums.weight, 1e-20);
    vec3 r = share * sums.r;
    vec3 m = share * sums.m;
    vec3 squares = share * sums.squares;
    vec3 products = share * sums.products;
    vec3 own = squares - r * r;
    vec3 mixed = products - mixed_products(r, r);
    mat3 turns = share * sums.turns - outerProduct(m, r);
    mat3 both = turns + transpose(turns);
    mat3 axes = mat3(1.0);
    for (int sweep = 0; sweep < 4; ++sweep) {
        rotate(own.x, own.y, mixed.z, mixed.y, mixed.x, axes[0], axes[1]);
        rotate(own.x, own.z, mixed.y, mixed.z, mixed.x, axes[0], axes[2]);
        rotate(own.y, own.z, mixed.x, mixed.z, mixed.y, axes[1], axes[2]);
    }
    mat3 along_axes = transpose(axes) * both * axes;
    own = max(own, vec3(0.0)) + FIT_RIDGE;
    for (int i = 0; i < 3; ++i) along_axes[i] /= own + own[i];
    mat3 h = axes * along_axes * transpose(axes);
    Quadric q;
    q.h.diagonal = vec3(h[0][0], h[1][1], h[2][2]);
    q.h.mixed = vec3(h[1][2], h[0][2], h[0][1]);
    q.g = m - bent(q.h, r);
    q.c = -dot(q.g, r) - 0.5 * dot(q.h.diagonal, squares) - dot(q.h.mixed, products);
    return q;
}

struct Foot {
    vec3 at;
    vec3 slope;
    bool real;  // false: the quadric has no surface in reach
};

// Whether a point is the foot of a surface within `reach` of the quadric's origin.
bool is_foot(Quadric q, vec3 at, vec3 slope, Real reach) { return length(slope) >= 0.3 && abs(quadric_at(q, at)) < 0.05 && length(at) < reach; }

// The foot point: the surface point whose normal passes through the voxel. Starts at `at`; all positions are relative
// to the quadric's origin.
Foot foot_of(Quadric q, vec3 voxel_at, vec3 at) {
    for (int i = 0; i < FOOT_STEPS; ++i) {
        vec3 slope = quadric_slope(q, at);
        Real steep = length(slope);
        vec3 up = slope / max(steep, 1e-6);
        Real bend = dot(up, bent(q.h, up));
        Real value = quadric_at(q, at);
        Real moved = -2.0 * value / (steep + sqrt(max(steep * steep - 2.0 * value * bend, 0.0)) + 1e-6);
        at += clamp(moved, -1.0, 1.0) * up;
        vec3 from = at - voxel_at;
        at -= i + 2 < FOOT_STEPS ? 0.7 * (from - dot(from, up) * up) : vec3(0.0);
    }
    vec3 slope = quadric_slope(q, at);
    Foot foot = {at, slope, is_foot(q, at, slope, FIT_RADIUS)};
    return foot;
}
#endif

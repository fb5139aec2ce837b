// Footprints of splats smaller than a pixel: the kernel's footprint, widened by the pixel's own (EWA volume splatting,
// Zwicker et al. 2002). docs/method/smoothing.md, Antialiasing. Written in the subset of GLSL that is C++.
#ifndef EDGESPLAT_LOW_PASS_GLSL
#define EDGESPLAT_LOW_PASS_GLSL

// A = the 2x2 form of the pixel's sides, in voxels, perpendicular to the ray: |x|^2 becomes x (1 + A)^-1 x.
struct LowPass {
    Real share;      // of the widened footprint in the result; 0 if a pixel is smaller than half a voxel
    Real of_pixels;  // det A / det(1 + A): weight of the distance in pixels, squared
    Real of_voxels;  // 1 / det(1 + A): weight of the distance in voxels, squared
    Real reach;      // radius of the widened support, voxels
};

// `across`, `down`: sides of a pixel at the splat, index space; u: direction of the ray; `support`: radius of the kernel.
LowPass low_pass(vec3 across, vec3 down, vec3 u, Real support) {
    across -= dot(across, u) * u;
    down -= dot(down, u) * u;
    Real a = dot(across, across);
    Real b = dot(down, down);
    Real c = dot(across, down);
    LowPass f;
    f.share = smoothstep(0.5, 1.0, sqrt(max(a, b)));
    // Division by `unit` prevents overflow for large pixels.
    Real unit = max(1.0, max(a, b));
    a /= unit;
    b /= unit;
    c /= unit;
    Real det = max(a * b - c * c, 0.0);
    Real trace = a + b;
    Real widening = 1.0 / unit / unit + trace / unit + det;
    f.of_pixels = det / widening;
    f.of_voxels = 1.0 / unit / unit / widening;
    f.reach = support * sqrt(1.0 + unit * (0.5 * trace + sqrt(max(0.25 * trace * trace - det, 0.0))));
    return f;
}

// Integral of a voxel's kernel when it is drawn unwarped: its share of the matter between the faces around it. The sum
// over the layers at a face is the distance to that face. `carried`: voxels on the other side of the face have a share,
// too.
Real matter_between(Real d, Real d2, bool carried) {
    Real whole = carried ? 0.5 : 1.0;
    Real near = d < whole ? max(d + 0.5, 0.0) : 1.0;
    Real far = d2 < whole ? max(d2 + 0.5, 0.0) : 1.0;
    return !carried && d + d2 < 1.0 ? 1.0 : max(near + far - 1.0, 0.0);
}
#endif

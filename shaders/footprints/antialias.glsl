// Footprints of splats smaller than a pixel: the kernel's footprint, widened by the pixel's own (EWA volume splatting,
// Zwicker et al. 2002). docs/method.md, pass 5, "Antialiasing".
#ifndef EDGESPLAT_ANTIALIAS_GLSL
#define EDGESPLAT_ANTIALIAS_GLSL

// A = the 2x2 form of the pixel's sides, in voxels, perpendicular to the ray: |x|^2 becomes x (1 + A)^-1 x.
struct LowPass {
    float share;      // of the widened footprint in the result; 0 if a pixel is smaller than half a voxel
    float of_pixels;  // det A / det(1 + A): weight of the distance in pixels, squared
    float of_voxels;  // 1 / det(1 + A): weight of the distance in voxels, squared
    float reach;      // radius of the widened support, voxels
};

// `across`, `down`: sides of a pixel at the splat, index space; u: direction of the ray.
LowPass low_pass(vec3 across, vec3 down, vec3 u, float support) {
    across -= dot(across, u) * u;
    down -= dot(down, u) * u;
    float a = dot(across, across), b = dot(down, down), c = dot(across, down);
    LowPass f;
    f.share = smoothstep(0.5, 1.0, sqrt(max(a, b)));
    // Division by `unit` prevents overflow for large pixels.
    float unit = max(1.0, max(a, b));
    a /= unit;
    b /= unit;
    c /= unit;
    float det = max(a * b - c * c, 0.0), trace = a + b;
    float widening = 1.0 / unit / unit + trace / unit + det;
    f.of_pixels = det / widening;
    f.of_voxels = 1.0 / unit / unit / widening;
    f.reach = support * sqrt(1.0 + unit * (0.5 * trace + sqrt(max(0.25 * trace * trace - det, 0.0))));
    return f;
}

// Integral of a voxel's kernel when it is drawn unwarped: its share of the matter between the faces around it. The sum
// over the layers at a face is the distance to that face. `carried`: voxels on the other side of the face have a share,
// too.
float matter_of_voxel(float d, float d2, bool carried) {
    float whole = carried ? 0.5 : 1.0;
    float near = d < whole ? max(d + 0.5, 0.0) : 1.0;
    float far = d2 < whole ? max(d2 + 0.5, 0.0) : 1.0;
    return !carried && d + d2 < 1.0 ? 1.0 : max(near + far - 1.0, 0.0);
}

#endif

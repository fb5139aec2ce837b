// The kernel and its integrals over a line and a part of one. docs/method/5_draw.md. Written in the subset of GLSL that is C++:
// shaders include it in float, kernel.h in double. The includer declares the kernel: KERNEL_R, KERNEL_R2, KERNEL_INVERSE_R2, the
// arrays KERNEL_K and KERNEL_G of the coefficients of K and of its footprint, and KERNEL_SET: where they begin.
#ifndef EDGESPLAT_KERNEL_GLSL
#define EDGESPLAT_KERNEL_GLSL

// `inside`: 1 - r^2 / R^2; the kernel is 0 where this is negative.
Real kernel_at(Real inside) {
    Real w = max(0.0, inside);
    int k = KERNEL_SET;
    return w * w * (KERNEL_K[k] + w * (KERNEL_K[k + 1] + w * (KERNEL_K[k + 2] + w * (KERNEL_K[k + 3] +
           w * (KERNEL_K[k + 4] + w * KERNEL_K[k + 5])))));
}

Real kernel(Real r2) { return kernel_at(1.0 - r2 * KERNEL_INVERSE_R2); }

// Integral of K along a line that passes its centre at squared distance rho2.
Real kernel_footprint(Real rho2) {
    Real w = max(0.0, 1.0 - rho2 * KERNEL_INVERSE_R2);
    int k = KERNEL_SET;
    return w * w * sqrt(w) * (KERNEL_G[k] + w * (KERNEL_G[k + 1] + w * (KERNEL_G[k + 2] + w * (KERNEL_G[k + 3] +
           w * (KERNEL_G[k + 4] + w * KERNEL_G[k + 5])))));
}

// Integral of K along that line from its point nearest to the voxel to z; odd in z. On the line K's argument is w (1 - s^2)
// with s = z / half chord; I_n = integral of (1 - s^2)^n from 0 to s obeys (2n + 1) I_n = s (1 - s^2)^n + 2n I_(n-1).
Real kernel_chord(Real rho2, Real z) {
    Real w = max(0.0, 1.0 - rho2 * KERNEL_INVERSE_R2);
    Real half_chord = KERNEL_R * sqrt(w);
    Real s = clamp(z / max(half_chord, 1e-6), -1.0, 1.0);
    Real c = 1.0 - s * s;
    Real i1 = s - s * s * s * (1.0 / 3.0);
    Real c2 = s * c * c;
    Real c3 = c2 * c;
    Real c4 = c3 * c;
    Real c5 = c4 * c;
    Real c6 = c5 * c;
    Real c7 = c6 * c;
    Real i2 = c2 * (1.0 / 5.0) + i1 * (4.0 / 5.0);
    Real i3 = c3 * (1.0 / 7.0) + i2 * (6.0 / 7.0);
    Real i4 = c4 * (1.0 / 9.0) + i3 * (8.0 / 9.0);
    Real i5 = c5 * (1.0 / 11.0) + i4 * (10.0 / 11.0);
    Real i6 = c6 * (1.0 / 13.0) + i5 * (12.0 / 13.0);
    Real i7 = c7 * (1.0 / 15.0) + i6 * (14.0 / 15.0);
    int k = KERNEL_SET;
    return half_chord * w * w * (KERNEL_K[k] * i2 + w * (KERNEL_K[k + 1] * i3 + w * (KERNEL_K[k + 2] * i4 +
           w * (KERNEL_K[k + 3] * i5 + w * (KERNEL_K[k + 4] * i6 + w * KERNEL_K[k + 5] * i7)))));
}

Real kernel_between(Real rho2, Real low, Real high) { return kernel_chord(rho2, high) - kernel_chord(rho2, low); }
#endif

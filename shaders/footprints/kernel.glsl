// The kernels: the float32 mirror of footprints/kernel.h. Written in the subset of GLSL that is also C++. The including
// shader declares NARROW: 1 if all matter is opaque and faces cut kernels.
#ifndef EDGESPLAT_KERNEL_GLSL
#define EDGESPLAT_KERNEL_GLSL

#define KERNEL_R (NARROW == 1u ? 1.21 : 1.6)
#define KERNEL_R2 (NARROW == 1u ? 1.4641 : 2.56)
#define KERNEL_INVERSE_R2 (NARROW == 1u ? 0.683013455 : 0.390625)
// Coefficients of K and of its footprint: first of the wide kernel, then of the narrow one.
const float KERNEL_K[12] = {0.0173624837, -0.0404017909, 0.531403221, -0.680940898, 1.37803587, -0.611612954,
                            1.3647426, -7.69352155, 25.8377679, -41.6868634, 33.3112006, -10.4390086};
const float KERNEL_G[12] = {0.0296319722, -0.0591020484, 0.690992887, -0.804944854, 1.50367897, -0.622885261,
                            1.76142778, -8.51123299, 25.4079587, -37.2667325, 27.4884516, -8.0399995};
#define KERNEL_SET (NARROW == 1u ? 6 : 0)

// ---- kernel (footprints/kernel.h)

// `inside`: 1 - r^2 / R^2; the kernel is 0 where this is negative.
float kernel_at(float inside) {
    float w = max(0.0, inside);
    int k = KERNEL_SET;
    return w * w * (KERNEL_K[k] + w * (KERNEL_K[k + 1] + w * (KERNEL_K[k + 2] + w * (KERNEL_K[k + 3] +
           w * (KERNEL_K[k + 4] + w * KERNEL_K[k + 5])))));
}

float kernel(float r2) { return kernel_at(1.0 - r2 * KERNEL_INVERSE_R2); }

float kernel_footprint(float rho2) {
    float w = max(0.0, 1.0 - rho2 * KERNEL_INVERSE_R2);
    int k = KERNEL_SET;
    return w * w * sqrt(w) * (KERNEL_G[k] + w * (KERNEL_G[k + 1] + w * (KERNEL_G[k + 2] + w * (KERNEL_G[k + 3] +
           w * (KERNEL_G[k + 4] + w * KERNEL_G[k + 5])))));
}

// Integral of K along the ray from its point nearest to the voxel to z. kernel_chord in kernel.cpp explains the
// recurrence.
float kernel_chord(float rho2, float z) {
    float w = max(0.0, 1.0 - rho2 * KERNEL_INVERSE_R2);
    float half_chord = KERNEL_R * sqrt(w);
    float s = clamp(z / max(half_chord, 1e-6), -1.0, 1.0);
    float c = 1.0 - s * s;
    float i1 = s - s * s * s * (1.0 / 3.0);
    float c2 = s * c * c;
    float c3 = c2 * c;
    float c4 = c3 * c;
    float c5 = c4 * c;
    float c6 = c5 * c;
    float c7 = c6 * c;
    float i2 = c2 * (1.0 / 5.0) + i1 * (4.0 / 5.0);
    float i3 = c3 * (1.0 / 7.0) + i2 * (6.0 / 7.0);
    float i4 = c4 * (1.0 / 9.0) + i3 * (8.0 / 9.0);
    float i5 = c5 * (1.0 / 11.0) + i4 * (10.0 / 11.0);
    float i6 = c6 * (1.0 / 13.0) + i5 * (12.0 / 13.0);
    float i7 = c7 * (1.0 / 15.0) + i6 * (14.0 / 15.0);
    int k = KERNEL_SET;
    return half_chord * w * w * (KERNEL_K[k] * i2 + w * (KERNEL_K[k + 1] * i3 + w * (KERNEL_K[k + 2] * i4 +
           w * (KERNEL_K[k + 3] * i5 + w * (KERNEL_K[k + 4] * i6 + w * KERNEL_K[k + 5] * i7)))));
}

float kernel_between(float rho2, float low, float high) { return kernel_chord(rho2, high) - kernel_chord(rho2, low); }
#endif

// The kernel: the float32 mirror of footprints/kernel.h. The subset of GLSL that is C++ too.
#ifndef EDGESPLAT_KERNEL_GLSL
#define EDGESPLAT_KERNEL_GLSL

const float KERNEL_R = 1.6;
const float KERNEL_R2 = 2.56;
const float KERNEL_INVERSE_R2 = 0.390625;

// ---- kernel (footprints/kernel.h)

// `inside`: 1 - r^2 / R^2; nothing where that is negative.
float kernel_at(float inside) {
    float w = max(0.0, inside);
    return w * w * (0.0173624837 + w * (-0.0404017909 + w * (0.531403221 + w * (-0.680940898 +
           w * (1.37803587 + w * -0.611612954)))));
}

float kernel(float r2) { return kernel_at(1.0 - r2 * KERNEL_INVERSE_R2); }

float kernel_footprint(float rho2) {
    float w = max(0.0, 1.0 - rho2 * KERNEL_INVERSE_R2);
    return w * w * sqrt(w) * (0.0296319722 + w * (-0.0591020484 + w * (0.690992887 + w * (-0.804944854 +
           w * (1.50367897 + w * -0.622885261)))));
}
#endif

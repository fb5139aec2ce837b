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

// Integral of K along the line from its nearest point to z; kernel_chord in kernel.cpp has the recurrence.
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
    return half_chord * w * w * (0.0173624837 * i2 + w * (-0.0404017909 * i3 + w * (0.531403221 * i4 +
           w * (-0.680940898 * i5 + w * (1.37803587 * i6 + w * -0.611612954 * i7)))));
}

float kernel_between(float rho2, float low, float high) { return kernel_chord(rho2, high) - kernel_chord(rho2, low); }
#endif

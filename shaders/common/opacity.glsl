#ifndef EDGESPLAT_OPACITY_GLSL
#define EDGESPLAT_OPACITY_GLSL
// 1 - exp(-tau) with a relative error of 1e-6. Vulkan's exp alone loses all digits of a small tau.
float opacity(float tau) {
    float series = tau * (1.0 - tau * (0.5 - tau * (1.0 / 6.0 - tau * (1.0 / 24.0 - tau * (1.0 / 120.0 - tau / 720.0)))));
    return tau < 0.5 ? series : 1.0 - exp(-tau);
}
#endif

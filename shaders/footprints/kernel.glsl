// The kernels in float. The including shader declares NARROW: 1 if all matter is opaque and faces cut kernels. Written in
// the subset of GLSL that is also C++.
#ifndef EDGESPLAT_KERNELS_GLSL
#define EDGESPLAT_KERNELS_GLSL
#include "footprints/in_float.glsl"

#define KERNEL_R (NARROW == 1u ? 1.21 : 1.6)
#define KERNEL_R2 (NARROW == 1u ? 1.4641 : 2.56)
#define KERNEL_INVERSE_R2 (NARROW == 1u ? 0.683013455 : 0.390625)
// Coefficients of K and of its footprint: first of the wide kernel, then of the narrow one (footprints/kernel.h).
const float KERNEL_K[12] = {0.0173624837, -0.0404017909, 0.531403221, -0.680940898, 1.37803587, -0.611612954,
                            1.3647426, -7.69352155, 25.8377679, -41.6868634, 33.3112006, -10.4390086};
const float KERNEL_G[12] = {0.0296319722, -0.0591020484, 0.690992887, -0.804944854, 1.50367897, -0.622885261,
                            1.76142778, -8.51123299, 25.4079587, -37.2667325, 27.4884516, -8.0399995};
#define KERNEL_SET (NARROW == 1u ? 6 : 0)

#include "footprints/kernel.glsl"
#endif

// What the files in the subset of GLSL that is C++ call by other names, in single precision.
#ifndef EDGESPLAT_IN_FLOAT_GLSL
#define EDGESPLAT_IN_FLOAT_GLSL
#define Real float
#define INOUT(type) inout type
#define CONSTANT const
#endif

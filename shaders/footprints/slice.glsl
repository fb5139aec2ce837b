// A piece of a ray, z along u from the ray's reference point.
#ifndef EDGESPLAT_SLICE_GLSL
#define EDGESPLAT_SLICE_GLSL
struct Slice {
    float low;
    float high;
};
#endif

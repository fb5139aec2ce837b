// What footprint.glsl needs to know besides the ray and the edge: one struct for C++ and GLSL, only 4-byte scalars, so every
// buffer layout (std140, std430, scalar) is the same 48 bytes.
#ifndef EDGESPLAT_FOOTPRINT_PARAMS_H
#define EDGESPLAT_FOOTPRINT_PARAMS_H
#ifdef __cplusplus
namespace edgesplat::shared {
using uint = unsigned int;
#endif

struct FootprintParams {
    float half_width;        // a, voxels
    float strength;          // k, slope at the edge
    float table_extent;      // FootprintTable::extent(), voxels
    float table_width;       // FootprintTableSize, as floats: they only enter texture coordinates
    float table_height;
    uint table_distances;
    uint table_directions;
    float paper_inset;       // PaperShape
    float paper_rise;
    uint paper_smooth;       // 1: PaperCurve::Smooth
    uint reserved0;
    uint reserved1;
};

#ifdef __cplusplus
static_assert(sizeof(FootprintParams) == 48);
}  // namespace edgesplat::shared
#endif
#endif

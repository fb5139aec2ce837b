// What shaders/lib/footprint.glsl needs to know besides the ray and the edge: one struct for C++ and GLSL, only 4-byte
// scalars, so that every buffer layout (std140, std430, scalar) is the same 48 bytes.
#ifndef EDGESPLAT_FOOTPRINT_PARAMS_H
#define EDGESPLAT_FOOTPRINT_PARAMS_H
#ifdef __cplusplus
#include <cstdint>
namespace edgesplat::shader {
using uint = std::uint32_t;
#endif

struct FootprintParams {
    float half_width;    // a, voxels: EdgeBand::half_width
    float strength;      // k, slope at the edge: EdgeBand::strength
    float table_extent;  // FootprintTable::extent(), voxels
    float table_width;   // FootprintTableSize, as floats: they only enter texture coordinates
    float table_height;
    float table_distances;
    float table_directions;
    float paper_inset;  // PaperShape::inset
    float paper_rise;   // PaperShape::rise, voxels
    uint paper_smooth;  // 1: PaperCurve::Smooth
    uint pad0;
    uint pad1;
};

#ifdef __cplusplus
static_assert(sizeof(FootprintParams) == 48);
}  // namespace edgesplat::shader
#endif
#endif

// Parameters of shaders/footprints/footprint.glsl besides ray and edge: one struct for C++ and GLSL. It has only 4-byte
// scalars, so every buffer layout (std140, std430, scalar) gives the same 16 bytes.
#ifndef EDGESPLAT_FOOTPRINT_PARAMS_H
#define EDGESPLAT_FOOTPRINT_PARAMS_H
#ifdef __cplusplus
#include <cstdint>
namespace edgesplat::shader {
using uint = std::uint32_t;
#endif

struct FootprintParams {
    float paper_inset;  // PaperShape::inset
    float paper_rise;   // PaperShape::rise, voxels
    uint paper_smooth;  // 1: PaperCurve::Smooth
    float paper_reach;  // kPaperReach, voxels
};

#ifdef __cplusplus
static_assert(sizeof(FootprintParams) == 16);
}  // namespace edgesplat::shader
#endif
#endif

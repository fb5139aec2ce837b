// The fixed size of the footprint table and the packing of a splat's layer. footprints/footprint_table.h describes its
// content.
#ifndef EDGESPLAT_SHARED_FOOTPRINT_TABLE_H
#define EDGESPLAT_SHARED_FOOTPRINT_TABLE_H
#include "shaders/shared/glue.h"
EDGESPLAT_SHARED_BEGIN

// Texels of a row: for rays that pass the face on the near side of the voxel, across it, and beyond it.
EDGESPLAT_CONSTANT uint TABLE_BEFORE = 20u;
EDGESPLAT_CONSTANT uint TABLE_ACROSS = 20u;
EDGESPLAT_CONSTANT uint TABLE_BESIDE = 8u;
EDGESPLAT_CONSTANT uint TABLE_WIDTH = 48u;
EDGESPLAT_CONSTANT uint TABLE_ROWS = 20u;
EDGESPLAT_CONSTANT uint TABLE_DISTANCES = 33u;   // one set of directions for each
EDGESPLAT_CONSTANT uint TABLE_DIRECTIONS = 25u;
EDGESPLAT_CONSTANT uint TABLE_LAYERS = 825u;

// 1/voxel; faces with a larger |H| are integrated: within a kernel they leave their tangent plane by a fifth of a voxel
// or more.
EDGESPLAT_CONSTANT float TABLE_BENDING = 0.15f;

// A splat's layer: bits 0-9 the first of the four blended layers, 10-19 the weight of the next distance, 20-29 the
// weight of the next direction.
EDGESPLAT_CONSTANT uint TABLE_BLEND_BITS = 10u;
EDGESPLAT_CONSTANT float TABLE_BLEND_STEPS = 1023.0f;

EDGESPLAT_SHARED_END

#ifdef __cplusplus
static_assert(edgesplat::shader::TABLE_BEFORE + edgesplat::shader::TABLE_ACROSS + edgesplat::shader::TABLE_BESIDE ==
              edgesplat::shader::TABLE_WIDTH);
static_assert(edgesplat::shader::TABLE_DISTANCES * edgesplat::shader::TABLE_DIRECTIONS ==
              edgesplat::shader::TABLE_LAYERS);
static_assert(edgesplat::shader::TABLE_LAYERS <= 1U << edgesplat::shader::TABLE_BLEND_BITS);
#endif
#endif

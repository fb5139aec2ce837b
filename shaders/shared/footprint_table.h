// The one size of the table of footprints, and what a splat is told of it. footprints/footprint_table.h says what it holds.
#ifndef EDGESPLAT_SHARED_FOOTPRINT_TABLE_H
#define EDGESPLAT_SHARED_FOOTPRINT_TABLE_H
#include "shaders/shared/glue.h"
EDGESPLAT_SHARED_BEGIN

// Texels of a row: of rays that pass the face on the near side of the voxel, across it, and beyond it.
EDGESPLAT_CONSTANT uint TABLE_BEFORE = 20u;
EDGESPLAT_CONSTANT uint TABLE_ACROSS = 20u;
EDGESPLAT_CONSTANT uint TABLE_BESIDE = 8u;
EDGESPLAT_CONSTANT uint TABLE_WIDTH = 48u;
EDGESPLAT_CONSTANT uint TABLE_ROWS = 20u;
EDGESPLAT_CONSTANT uint TABLE_DISTANCES = 33u;   // layers: a set of directions for each
EDGESPLAT_CONSTANT uint TABLE_DIRECTIONS = 25u;
EDGESPLAT_CONSTANT uint TABLE_LAYERS = 825u;

// Faces bent more than this, 1/voxel, are integrated: within a kernel they leave their tangent plane by a fifth of a voxel and more.
EDGESPLAT_CONSTANT float TABLE_BENDING = 0.15f;

// A splat's layer: bits 0-9 the first of the four that are blended, 10-19 how far towards the next distance, 20-29 towards the next
// direction.
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

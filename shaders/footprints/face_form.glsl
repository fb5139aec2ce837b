// A splat's face, as the drawing passes need it. The including shader declares the constants FOOTPRINTS and WARP.
#ifndef EDGESPLAT_FACE_FORM_GLSL
#define EDGESPLAT_FACE_FORM_GLSL
#include "shaders/shared/scene_params.h"
#include "shaders/footprints/face_record.glsl"
#include "shaders/footprints/kernel.glsl"
#include "footprints/in_float.glsl"
#include "footprints/face_types.glsl"
#include "footprints/face_cut.glsl"
#include "engine/geometry/edge.glsl"
#include "engine/geometry/face_form.glsl"

const bool FACES = FOOTPRINTS != ISOTROPIC && WARP == FACE;  // kernels are cut at faces

layout(constant_id = SPEC_SURFACES) const uint SURFACES = 0u;

// Radius of the ball around its voxel in which a ray finds a surface splat's face. `error`: of the refused face.
float trace_reach(float error) { return error < SURFACE_LOST ? SURFACE_REACH : SURFACE_AROUND; }

const uint MATERIAL_BITS = 0xffu, FACES_UPWARD = 0x100u, HAS_NORMAL = 0x200u, IS_MIXED = 0x400u;  // bits of SplatInputs::number_material.y
const uint MAIN_AXIS_AT = 11u;  // from this bit on: the longest axis of the normal at the foot point, and its sign in the bit above
const uint IS_TRACED = 1u << 14u;  // rays find the face
#endif

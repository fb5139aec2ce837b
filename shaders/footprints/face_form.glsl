// A splat's face as rays meet it. The including shader declares the constants FOOTPRINTS and WARP.
#ifndef EDGESPLAT_FACE_FORM_GLSL
#define EDGESPLAT_FACE_FORM_GLSL
#include "shaders/shared/scene_params.h"
#include "shaders/footprints/face_record.glsl"
#include "shaders/footprints/kernel.glsl"
#include "shaders/footprints/face_cut.glsl"

const bool FACES = FOOTPRINTS != ISOTROPIC && WARP == FACE;  // kernels are cut at faces

// Or a plain kernel with the normal it is lit by.
struct FaceForm {
    float value;  // phi at the voxel's centre
    vec3 slope;   // its gradient there
    Bending h;
    FaceCut cut;  // depth < 0: the kernel is plain
    vec4 crease;  // normal and distance of another plane that cuts it, CREASE_NONE without
    float corner;  // distance of a third one, CORNER_NONE without (crease_record.glsl)
};

const uint MATERIAL_BITS = 0xffu, FACES_UPWARD = 0x100u, HAS_NORMAL = 0x200u, IS_MIXED = 0x400u;  // of SplatInputs::number_material.y
const uint MAIN_AXIS_AT = 11u;  // and the axis that the normal at the foot point is longest along, and its sign above
const uint IS_TRACED = 1u << 14u;  // rays find its face
#endif

// The label of a voxel. The including shader declares the variable `dims`. docs/method.md, Labels.
#include "shaders/drivers/if_any.glsl"
#include "shaders/shared/bindings.h"
layout(constant_id = SPEC_LABELS) const uint LABELS = 0u;
layout(binding = BIND_LABELS, r32ui) uniform readonly uimage3D labels;

// The voxel's own label, else that of the nearest voxel with one, within 2 voxels along each axis; 0: none. Labels of a
// scan are those of label_near in engine/volume/labels.h.
uint label_near(ivec3 p) {
    uint label = imageLoad(labels, p).r;
    bool searches = LABELS == LABELS_OF_MASK && label == 0u;
    IF_ANY(searches) {
        int nearest = searches ? 13 : 0;
        for (int i = 0; i < 125; ++i) {
            ivec3 there = clamp(p + ivec3(i % 5, i / 5 % 5, i / 25) - 2, ivec3(0), dims - 1), way = there - p;
            uint other = imageLoad(labels, there).r;
            int distance = way.x * way.x + way.y * way.y + way.z * way.z;
            bool nearer = other != 0u && distance < nearest;
            label = nearer ? other : label;
            nearest = nearer ? distance : nearest;
        }
    }
    return label;
}

// The label that a surface shows at a place. Written in the subset of GLSL that is C++. The includer declares `dims`,
// label_number(ivec3) of a voxel, and label_votes(ivec3, uint): whether the voxel is matter of a material, which may have
// a label.
#ifndef EDGESPLAT_SEEN_LABEL_GLSL
#define EDGESPLAT_SEEN_LABEL_GLSL

// The label with the largest sum of the weights (1 - r^2 / LABEL_VIEW^2)^2 of the voxels at distances r; 0: none. So the
// line between two labels has no stairs. If the 27 nearest voxels have one label, it is that.
uint seen_label(vec3 at, uint material) {
    ivec3 nearest = ivec3(roundEven(at));
    uint lowest = 0xffffffffu;
    uint highest = 0u;
    for (int i = 0; i < 27; ++i) {
        ivec3 q = clamp(nearest + ivec3(i % 3, i / 3 % 3, i / 9) - 1, ivec3(0), dims - 1);
        uint label = label_number(q);
        bool votes = label_votes(q, material);
        lowest = votes ? min(lowest, label) : lowest;
        highest = votes ? max(highest, label) : highest;
    }
    uint seen = highest;
    IF_ANY(lowest != highest) {
        uint labels[4];
        Real weights[4];
        for (int k = 0; k < 4; ++k) {
            labels[k] = 0u;
            weights[k] = 0.0;
        }
        ivec3 low = ivec3(floor(at)) - 2;
        for (int i = 0; i < 216; ++i) {
            ivec3 q = low + ivec3(i % 6, i / 6 % 6, i / 36);
            vec3 way = vec3(q) - at;
            Real w = max(1.0 - dot(way, way) / (LABEL_VIEW * LABEL_VIEW), 0.0);
            w *= w;
            ivec3 there = clamp(q, ivec3(0), dims - 1);
            uint label = label_number(there);
            bool counts = w > 0.0 && q == there && label_votes(there, material);
            // Of more than four labels, those with the smallest weights are forgotten.
            int least = 0;
            int place = 4;
            for (int k = 0; k < 4; ++k) {
                least = weights[k] < weights[least] ? k : least;
                place = weights[k] > 0.0 && labels[k] == label ? k : place;
            }
            bool is_new = counts && place == 4 && w > weights[least];
            for (int k = 0; k < 4; ++k) {
                bool replaced = is_new && k == least;
                labels[k] = replaced ? label : labels[k];
                weights[k] = replaced ? w : (counts && k == place ? weights[k] + w : weights[k]);
            }
        }
        Real most = 0.0;
        uint best = 0u;
        for (int k = 0; k < 4; ++k) {
            bool more = weights[k] > most;
            best = more ? labels[k] : best;
            most = more ? weights[k] : most;
        }
        seen = lowest != highest ? best : seen;
    }
    return seen;
}
#endif

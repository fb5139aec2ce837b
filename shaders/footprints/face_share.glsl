// How much of a kernel the matter next to a face holds: the float32 mirror of footprints/face_share.h. After
// shaders/footprints/kernel.glsl, in the subset of GLSL that is C++ too.
#ifndef EDGESPLAT_FACE_SHARE_GLSL
#define EDGESPLAT_FACE_SHARE_GLSL

// Gauss-Legendre on [0, 1] with 4 nodes.
const float SHARE_NODE[4] = {0.0694318442, 0.3300094782, 0.6699905218, 0.9305681558};
const float SHARE_WEIGHT[4] = {0.1739274226, 0.3260725774, 0.3260725774, 0.1739274226};

const float SHARE_BENDING = 0.1;  // kThinBending: matter that bends less has room for all of a kernel

struct FaceBody {
    float bend;
    float mean;
    float spread;
    float thickness;  // beyond FACE_NO_WALL there is no other face
};

float share_all_around(FaceBody body, float across, float depth) {
    float sum = 0.0;
    for (int i = 0; i < 4; ++i) {
        float rho2 = KERNEL_R2 * SHARE_NODE[i], rise = across * rho2;
        float at_face = 1.0 - body.bend * rise, at_other = at_face - 2.0 * body.bend * body.thickness;
        float slope = sqrt(max(at_face, 0.0));
        float high = body.bend > 1e-4 ? (1.0 + slope) / body.bend : 1e6;
        bool wall = body.thickness < FACE_NO_WALL && at_other >= 0.0;
        high = wall ? min(high, (rise + 2.0 * body.thickness) / (1.0 + sqrt(max(at_other, 0.0)))) : high;
        float kept = kernel_between(rho2, rise / (1.0 + slope) - depth, high - depth);
        sum += at_face > 0.0 ? SHARE_WEIGHT[i] * kept : 0.0;
    }
    return 8.04247719 * sum;  // pi R^2
}

float face_share(FaceBody body, float depth) {
    float apart = 0.707106781 * body.spread;
    float share = 0.5 * (share_all_around(body, body.mean + apart, depth) + share_all_around(body, body.mean - apart, depth));
    return clamp(share, kernel(0.0), 1.0);
}
#endif

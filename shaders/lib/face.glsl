// Kernels that a face cuts, along a ray: the float32 mirror of footprints/face.h (same names, same equations). After
// shaders/lib/footprint.glsl, in the subset of GLSL that is C++ too.
#ifndef EDGESPLAT_FACE_GLSL
#define EDGESPLAT_FACE_GLSL

#include "shaders/lib/face_cut.glsl"

const float FACE_STRAIGHT = 1e-6;

// c + z (b + z a).
struct Quadratic {
    float c;
    float b;
    float a;
};
float quadratic_at(Quadratic q, float z) { return q.c + z * (q.b + z * q.a); }

struct FaceRay {
    float rho2;
    Quadratic phi;
    Quadratic slope2;
    Quadratic along;
};

struct FaceFootprint {
    float integral;
    float entry;
    float side;  // -1: the ray enters by the wall's other face, else 1
};

struct FaceRoots {
    bool real;
    float low;
    float high;
};

FaceRoots face_roots(Quadratic phi, float level) {
    float c = phi.c + level;
    float a = abs(phi.a) < FACE_STRAIGHT ? (phi.a < 0.0 ? -FACE_STRAIGHT : FACE_STRAIGHT) : phi.a;
    float disc = phi.b * phi.b - 4.0 * a * c;
    float root = sqrt(max(disc, 0.0));
    float q = -0.5 * (phi.b + (phi.b < 0.0 ? -root : root));
    float far = q / a;
    float near = q != 0.0 ? c / q : far;
    FaceRoots r;
    r.real = disc >= 0.0;
    r.low = min(near, far);
    r.high = max(near, far);
    return r;
}

float face_kernel(FaceRay ray, FaceCut cut, float z) {
    float phi = quadratic_at(ray.phi, z);
    float slope2 = max(quadratic_at(ray.slope2, z), 1e-8);
    float slope = sqrt(slope2);
    float out_of = -2.0 * phi / (slope + sqrt(max(slope2 - 2.0 * phi * cut.bend, 0.0)) + 1e-12);
    float above = phi + cut.thickness;
    float behind = 2.0 * above / (slope + sqrt(max(slope2 - 2.0 * above * cut.bend, 0.0)) + 1e-12);
    float moved = min(out_of - cut.depth, 0.0) + max(cut.depth - behind, 0.0);
    return kernel(max(ray.rho2 + z * z + moved * (2.0 * quadratic_at(ray.along, z) / slope + moved), 0.0));
}

// Deeper than what is moved, so that beyond the plain kernel's reach there is nothing.
bool is_deep(FaceRay ray, FaceCut cut, float z) {
    float phi = quadratic_at(ray.phi, z), shallow2 = cut.depth * cut.depth * quadratic_at(ray.slope2, z);
    float above = phi + cut.thickness;
    return phi < 0.0 && phi * phi > shallow2 && above > 0.0 && above * above > shallow2;
}

FaceFootprint footprint_face(FaceRay ray, FaceCut cut, Slice slice) {
    FaceFootprint result;
    result.integral = 0.0;
    result.side = 1.0;
    float half_chord = sqrt(max(cut.reach2 - ray.rho2, 0.0));
    result.entry = 0.0;
    float plain = sqrt(max(KERNEL_R2 - ray.rho2, 0.0));
    float low = max(is_deep(ray, cut, -plain) ? -plain : -half_chord, slice.low);
    float high = min(is_deep(ray, cut, plain) ? plain : half_chord, slice.high);
    bool wall = cut.thickness < FACE_NO_WALL;
    bool opens = ray.phi.a >= 0.0;
    FaceRoots face = face_roots(ray.phi, 0.0);
    FaceRoots behind = face_roots(ray.phi, cut.thickness);
    behind.real = behind.real && wall;
    bool everywhere = !opens && !wall;
    bool has_outer = everywhere || (opens ? face.real : behind.real);
    float outer_low = everywhere ? -1e9 : (opens ? face.low : behind.low);
    float outer_high = everywhere ? 1e9 : (opens ? face.high : behind.high);
    bool has_inner = opens ? behind.real : face.real;
    float inner_low = opens ? behind.low : face.low;
    float inner_high = opens ? behind.high : face.high;
    int pieces = half_chord > 0.0 && has_outer ? (has_inner ? 2 : 1) : 0;
    bool entered = false;
    for (int i = 0; i < pieces; ++i) {
        float from = i == 0 ? outer_low : inner_high;
        float to = i == 0 && has_inner ? inner_low : outer_high;
        bool from_behind = i == 0 ? !opens && wall : opens;
        float begin = max(from, low);
        float len = max(min(to, high) - begin, 0.0);
        float sum = 0.0;
        for (int k = 0; k < FOOTPRINT_NODES; ++k)
            sum += FOOTPRINT_WEIGHT[FOOTPRINT_RULE + k] * face_kernel(ray, cut, begin + len * FOOTPRINT_NODE[FOOTPRINT_RULE + k]);
        result.integral += len * sum;
        bool first = len > 0.0 && !entered;
        result.entry = first ? clamp(from, -half_chord, half_chord) : result.entry;
        result.side = first && from_behind && from > -half_chord ? -1.0 : result.side;
        entered = entered || len > 0.0;
    }
    return result;
}
#endif

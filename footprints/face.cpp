#include "footprints/face.h"

#include <cmath>

#include "footprints/gauss_legendre.h"

namespace edgesplat {

namespace in_double {
namespace {

/// face.glsl, with the kernel and the rule that it asks for.
struct CutKernel : KernelSource {
    explicit CutKernel(const Kernel& kernel, FacePieces choice = FacePieces::Both, const QuadratureRule& rule = {})
        : KernelSource(kernel),
          FACE_PIECES(choice == FacePieces::Both ? 2 : 1),
          FOOTPRINT_NODES(static_cast<int>(rule.size())),
          FOOTPRINT_NODE(rule.nodes.data()),
          FOOTPRINT_WEIGHT(rule.weights.data()) {}

    uint FACE_PIECES;
    int FOOTPRINT_NODES;
    static constexpr int FOOTPRINT_RULE = 0;
    const double *FOOTPRINT_NODE, *FOOTPRINT_WEIGHT;

#define Real double
#include "footprints/face.glsl"
#undef Real
};

}  // namespace
}  // namespace in_double

using in_double::CutKernel;

double quadratic_at(const Quadratic& q, double z) {
    return CutKernel(kKernel).quadratic_at(q, z);
}

FaceRoots face_roots(const Quadratic& phi, double level) {
    return CutKernel(kKernel).face_roots(phi, level);
}

FaceCut face_cut(double distance, double bend, double norm, double thickness, double deepest, const Kernel& kernel) {
    return CutKernel(kernel).face_cut(distance, bend, norm, thickness, deepest);
}

FaceCut with_crease(const FaceCut& cut, double distance, const Kernel& kernel) {
    return CutKernel(kernel).with_crease(cut, distance);
}

FacePath::FacePath(const FaceRay& ray, const FaceCut& cut, const FaceCrease& crease, const Kernel& kernel,
                   FacePieces choice)
    : ray_(ray), cut_(cut), crease_(crease), kernel_(&kernel), choice_(choice) {
    CutKernel faces(kernel, choice);
    const CreaseEnds ends = is_creased() ? faces.crease_ends(crease) : faces.no_crease_ends();
    const FaceWay way = faces.face_way(ray, cut, is_creased(), ends);
    half_chord_ = way.half_chord;
    const auto add = [&](double low, double high, bool from_behind, bool to_behind) {
        pieces_.at(count_++) =
            faces.face_piece(ray, cut, is_creased(), crease, ends, way.half_chord, low, high, from_behind, to_behind);
    };
    if (way.there) add(way.low, way.high, way.from_behind, way.to_behind);
    if (way.there && way.both) add(way.second_low, way.second_high, way.second_from_behind, way.second_to_behind);
}

double FacePath::kernel_at(double z) const {
    if (!(std::abs(z) < half_chord_)) return 0;
    for (const FacePiece& piece : pieces())
        if (z >= piece.low && z <= piece.high)
            return CutKernel(*kernel_).kernel_in_piece(ray_, piece, is_creased(), crease_, z);
    return 0;
}

FaceFootprint FacePath::footprint(int nodes, const Slice& slice) const {
    return CutKernel(*kernel_, choice_, kept_gauss_legendre(nodes))
        .footprint_face(ray_, cut_, is_creased(), crease_, slice);
}

}  // namespace edgesplat

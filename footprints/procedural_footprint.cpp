// footprint.glsl in double precision, with the paper's curve as exact as paper_warp.h has it.
#include <stdexcept>

#include "footprints/footprint_integral.h"
#include "footprints/gauss_legendre.h"
#include "footprints/kernel.h"
#include "shaders/shared/footprint_params.h"

namespace edgesplat {

namespace in_double {
namespace {

struct PaperFootprint : KernelSource {
    explicit PaperFootprint(const Kernel& kernel, const PaperEdge& at = {}, const QuadratureRule& rule = {})
        : KernelSource(kernel, &kept_footprint_coefficients(kernel)),
          FOOTPRINT_NODES(static_cast<int>(rule.size())),
          FOOTPRINT_NODE(rule.nodes.data()),
          FOOTPRINT_WEIGHT(rule.weights.data()),
          edge(at),
          profile(paper_profile_for(at)) {}

    int FOOTPRINT_NODES;
    static constexpr int FOOTPRINT_RULE = 0;
    const double *FOOTPRINT_NODE, *FOOTPRINT_WEIGHT;
    PaperEdge edge;
    PaperProfile profile;

    using FootprintParams = shader::FootprintParams;
#define Real double
#include "footprints/paper_knots.glsl"
    // The curve is that of the edge, not of the rounded parameters.
    PaperKnots paper_knots(double, const FootprintParams&) const {
        return {paper_interval(edge), profile.t1, profile.t2, profile.m1, profile.m2};
    }
    double paper_map(double x, const PaperKnots&, const FootprintParams&) const {
        return edgesplat::paper_map(x, profile);
    }
// After what it uses.
#include "footprints/footprint.glsl"
#undef Real
};

}  // namespace
}  // namespace in_double

double sliced_kernel_footprint(double rho2, const Slice& slice, const Kernel& k) {
    return in_double::PaperFootprint(k).footprint_isotropic(rho2, slice);
}

double procedural_footprint(const Ray& ray, const PaperEdge& edge, int nodes, const Slice& slice) {
    if (nodes != 4 && nodes != 10) throw std::invalid_argument("procedural_footprint: nodes must be 4 or 10");
    return in_double::PaperFootprint(kKernel, edge, kept_gauss_legendre(nodes))
        .footprint_paper_procedural(ray.rho2, ray.pn, ray.un, edge.distance, slice, {});
}

double warp2d_footprint(const Ray& ray, const PaperEdge& edge, const Slice& slice) {
    return in_double::PaperFootprint(kKernel, edge)
        .footprint_paper_warp2d(ray.rho2, ray.pn, ray.un, edge.distance, slice, {});
}

}  // namespace edgesplat

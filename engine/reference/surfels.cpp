// Surfels: points of the surface beside voxels. Mirrors shaders/edges/find_surfel.glsl.
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/reference/faces.h"
#include "shaders/shared/limits.h"

namespace edgesplat::reference {

namespace {

using glm::dvec3;

constexpr auto kSurfelReach = static_cast<double>(shader::SURFEL_REACH);

/// The surfel of voxel i on the field's surface; without one only a normal.
VoxelEdge surfel_in_field(const Field& field, const ScaledScene& scene, const glm::ivec3& i, bool cubic) {
    const VoxelEdge none = edge_with_normal_only(field, i);
    const double f = field.at(i);
    const int m = scene.material(f);
    const double low = scene.lower(m), high = scene.upper(m);
    const auto [least, most] = values_around(field, i);
    if (least >= low && most < high) return none;
    const bool upper = most >= high && (least >= low || high - f < f - low);
    const double iso = upper ? high : low;
    const dvec3 x(i);
    dvec3 at = x, n(0);
    double off = 1;
    for (int step = 0; step < shader::SURFEL_STEPS; ++step) {
        const dvec3 g = cubic ? spline_gradient(field, at) : point_gradient(field, at);
        const double slope = glm::length(g);
        if (!(slope >= kSmallestGradient) || glm::distance(at, x) > 3) return none;
        n = g / slope;
        off = (sample(field, at, cubic) - iso) / slope;
        if (step + 1 == shader::SURFEL_STEPS) break;
        at -= std::clamp(off, -0.6, 0.6) * n;
        const dvec3 from = at - x;
        if (step >= 2 && step + 4 < shader::SURFEL_STEPS) at -= 0.5 * (from - glm::dot(from, n) * n);
    }
    const dvec3 from = at - x, last(field.dims - 1);
    n = upper ? n : -n;
    const double d = glm::dot(from, n);
    const bool inside = glm::all(glm::greaterThan(at, dvec3(-0.5))) && glm::all(glm::lessThan(at, last + 0.5));
    if (!(std::abs(off) < 2e-3 && glm::length(from - d * n) < 0.25 && std::abs(d) <= kSurfelReach && inside))
        return none;
    VoxelEdge edge;
    edge.n = n;
    edge.D = d;
    edge.upper = upper;
    edge.has_edge = edge.has_normal = true;
    return edge;
}

/// Outward normal of the volume's border beside voxel i, half a voxel beyond the outermost samples; 0 if there is none.
/// An axis of one voxel, which has a border on either side of each voxel, comes last.
dvec3 border_beside(const Field& field, const glm::ivec3& i) {
    dvec3 thin(0);
    for (int axis = 0; axis < 3; ++axis) {
        if (i[axis] != 0 && i[axis] != field.dims[axis] - 1) continue;
        dvec3 n(0);
        n[axis] = i[axis] == field.dims[axis] - 1 ? 1 : -1;
        if (field.dims[axis] > 1) return n;
        thin = n;
    }
    return thin;
}

/// Calls look with the samples around a voxel, its own included.
template <typename Look>
void for_samples_around(const Field& field, const glm::ivec3& i, const Look& look) {
    for (int k = 0; k < 27; ++k)
        look(field.at(i + glm::ivec3(k % 3, k / 3 % 3, k / 9) - 1));
    for (int axis = 0; axis < 3; ++axis) {
        glm::ivec3 o(0);
        o[axis] = 2;
        look(field.at(i + o));
        look(field.at(i - o));
    }
}

}  // namespace

std::pair<double, double> values_around(const Field& field, const glm::ivec3& i) {
    std::pair around(field.at(i), field.at(i));
    for_samples_around(field, i, [&](double f) { around = {std::min(around.first, f), std::max(around.second, f)}; });
    return around;
}

double least_data_around(const Field& field, const glm::ivec3& i) {
    double least = std::numeric_limits<double>::infinity();
    for_samples_around(field, i, [&](double f) { least = f >= 0 ? std::min(least, f) : least; });
    return least;
}

VoxelEdge edge_with_normal_only(const Field& field, const glm::ivec3& i) {
    VoxelEdge edge;
    const dvec3 g = voxel_gradient(field, i);
    edge.has_normal = glm::length(g) >= kSmallestGradient;
    if (edge.has_normal) edge.n = -g / glm::length(g);
    return edge;
}

VoxelEdge find_surfel(const Field& field, const ScaledScene& scene, const glm::ivec3& i, bool cubic) {
    VoxelEdge edge = surfel_in_field(field, scene, i, cubic);
    const dvec3 out_of = border_beside(field, i);
    if (glm::dot(out_of, out_of) == 0 || (edge.has_edge && std::abs(edge.D) <= 0.5)) return edge;
    edge = {};
    edge.n = out_of;
    edge.D = 0.5;
    edge.has_edge = edge.has_normal = edge.border = true;
    return edge;
}

}  // namespace edgesplat::reference

// Faces when splats are drawn: how they are stored, cut a kernel and appear along a ray.
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/reference/faces.h"
#include "shaders/shared/footprint_table.h"
#include "shaders/shared/limits.h"

namespace edgesplat::reference {

using glm::dmat3;
using glm::dvec3;

namespace {

constexpr auto kCreaseReach = static_cast<double>(shader::CREASE_REACH);
constexpr auto kBendingUnit = static_cast<double>(shader::BENDING_UNIT);

}  // namespace

double norm_of(const dmat3& bending) {
    double norm2 = 0;
    for (int i = 0; i < 3; ++i)
        norm2 += glm::dot(bending[i], bending[i]);
    return std::sqrt(norm2);
}

dmat3 quantise_bending(const dmat3& bending) {
    const auto through = [](double h) {
        const double root = std::clamp(std::sqrt(std::abs(h) / kBendingUnit), 0.0, 1.0);
        const double code = std::copysign(std::round(root * 511) / 511, h);
        return code * std::abs(code) * kBendingUnit;
    };
    dmat3 stored;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            stored[i][j] = through(0.5 * (bending[i][j] + bending[j][i]));
    return stored;
}

FaceCut cut_of(const VoxelEdge& edge, const Kernel& kernel) {
    const bool wall = edge.D2 < kFaceFarthest;
    const double thickness = wall ? std::max(edge.D + edge.D2, 0.05) : std::numeric_limits<double>::infinity();
    const double bend = glm::dot(edge.n, edge.bending * edge.n);
    FaceCut cut = face_cut(edge.D, bend, norm_of(edge.bending), thickness, edge.deepest, kernel);
    const dvec3 own = edge.n - edge.bending * (edge.D * edge.n);
    add_crease(cut, {edge.crease.D, glm::dot(own, edge.crease.n)}, edge.corner.D);
    return cut;
}

bool is_in_table(const VoxelEdge& edge, const Settings& settings) {
    return draws_table(settings) && edge.D2 >= edge_reach(settings) && edge.crease.D >= kCreaseReach &&
           norm_of(edge.bending) <= static_cast<double>(shader::TABLE_BENDING);
}

VoxelEdge drawn_edge(const VoxelEdge& edge, const Settings& settings) {
    VoxelEdge drawn = edge;
    if (is_in_table(edge, settings)) drawn.bending = dmat3(0);
    return drawn;
}

FaceSight face_sight(const VoxelEdge& edge, const dvec3& p, const dvec3& u) {
    const dmat3& h = edge.bending;
    const dvec3 at_foot = h * (edge.D * edge.n);
    const double value = -edge.D + 0.5 * edge.D * glm::dot(edge.n, at_foot);
    const dvec3 own = edge.n - at_foot, hp = h * p, hu = h * u, slope = own + hp;
    FaceSight sight;
    sight.slope = slope;
    sight.turn = hu;
    sight.ray.rho2 = glm::dot(p, p);
    sight.ray.phi = {value + 0.5 * glm::dot(own + slope, p), glm::dot(slope, u), 0.5 * glm::dot(u, hu)};
    sight.ray.slope2 = {glm::dot(slope, slope), 2 * glm::dot(slope, hu), glm::dot(hu, hu)};
    sight.ray.across = glm::dot(p, slope);
    sight.ray.turn = glm::dot(p, hu);
    sight.ray.crease = {glm::dot(edge.crease.n, p), glm::dot(edge.crease.n, u)};
    sight.ray.corner = {glm::dot(edge.corner.n, p), glm::dot(edge.corner.n, u)};
    return sight;
}

}  // namespace edgesplat::reference

#include "engine/reference/faces.h"

#include <algorithm>
#include <cmath>

#include "engine/reference/field_geometry.h"
#include "shaders/shared/footprint_table.h"
#include "shaders/shared/limits.h"

namespace edgesplat::reference {

using glm::dmat3;

namespace {

constexpr auto kCreaseReach = static_cast<double>(shader::CREASE_REACH);
constexpr auto kBendingUnit = static_cast<double>(shader::BENDING_UNIT);

}  // namespace

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

bool is_in_table(const VoxelEdge& edge, const Settings& settings) {
    return draws_table(settings) && edge.D2 >= edge_reach(settings) && edge.crease.D >= kCreaseReach &&
           geometry::bending_norm(geometry::bending_of(edge.bending)) <= static_cast<double>(shader::TABLE_BENDING);
}

VoxelEdge drawn_edge(const VoxelEdge& edge, const Settings& settings) {
    VoxelEdge drawn = edge;
    if (is_in_table(edge, settings)) drawn.bending = dmat3(0);
    return drawn;
}

}  // namespace edgesplat::reference

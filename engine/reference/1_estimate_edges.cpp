#include "engine/reference/1_estimate_edges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "engine/reference/creases.h"
#include "engine/reference/faces.h"
#include "engine/volume/parallel.h"
#include "footprints/kernel.h"
#include "shaders/shared/limits.h"

namespace edgesplat::reference {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The edge of a voxel without a surface in reach: only the normal -g / |g|, unless |g| is too small.
VoxelEdge normal_only(const glm::dvec3& g) {
    VoxelEdge edge;
    const double length = glm::length(g);
    edge.has_normal = length >= kSmallestGradient;
    if (edge.has_normal) edge.n = -g / length;
    return edge;
}

/// `taylor`: first-order distance from the voxel's own value and gradient.
VoxelEdge one_step(const Field& field, const ScaledScene& scene, const Settings& settings, const glm::ivec3& i) {
    const glm::dvec3 g = voxel_gradient(field, i);
    VoxelEdge edge = normal_only(g);
    if (!edge.has_normal) return edge;
    const double f = field.at(i);
    const double slope = glm::length(g);
    const int m = scene.material(f);
    const double down = (f - scene.lower(m)) / slope;
    const double up = (scene.upper(m) - f) / slope;
    edge.upper = up < down;
    edge.D = std::min(up, down);
    edge.has_edge = edge.D <= edge_reach(settings);
    if (!edge.has_edge) return normal_only(g);
    if (edge.upper) edge.n = g / slope;
    return edge;
}

double snorm16(double v) {
    return std::round(std::clamp(v, -1.0, 1.0) * 32767) / 32767;
}

double sign_not_zero(double v) {
    return v >= 0 ? 1.0 : -1.0;
}

glm::dvec3 through_octahedron(const glm::dvec3& n) {
    const glm::dvec3 a = n / (std::abs(n.x) + std::abs(n.y) + std::abs(n.z));
    double x = a.x;
    double y = a.y;
    if (a.z < 0) {
        x = (1 - std::abs(a.y)) * sign_not_zero(a.x);
        y = (1 - std::abs(a.x)) * sign_not_zero(a.y);
    }
    x = snorm16(x);
    y = snorm16(y);
    glm::dvec3 r(x, y, 1 - std::abs(x) - std::abs(y));
    if (r.z < 0) {
        r.x = (1 - std::abs(y)) * sign_not_zero(x);
        r.y = (1 - std::abs(x)) * sign_not_zero(y);
    }
    return glm::normalize(r);
}

/// Sentinel for a voxel outside translucent matter, out of reach of its face: this splat is not drawn.
VoxelEdge carries_nothing() {
    VoxelEdge edge;
    edge.n = {0, 0, 1};
    edge.D = static_cast<double>(shader::CARRIES_NOTHING);
    edge.has_edge = edge.has_normal = true;
    return edge;
}

template <typename Work>
std::vector<VoxelEdge> per_drawn_voxel(const Field& field, const ScaledScene& scene, const Work& work) {
    std::vector<VoxelEdge> edges(field.values.size());
    parallel_for(field.dims.z, [&](int begin, int end) {
        for (int z = begin; z < end; ++z) {
            for (int y = 0; y < field.dims.y; ++y) {
                for (int x = 0; x < field.dims.x; ++x) {
                    const glm::ivec3 i(x, y, z);
                    const auto m = static_cast<std::size_t>(scene.material(field.at(i)));
                    if (scene.drawn[m]) edges[field.offset(i)] = work(i);
                }
            }
        }
    });
    return edges;
}

}  // namespace

std::vector<VoxelEdge> estimate_edges(const Field& field, const ScaledScene& scene, const Settings& settings,
                                      bool quantised) {
    return per_drawn_voxel(field, scene, [&](const glm::ivec3& i) {
        VoxelEdge edge;
        if (settings.edges == EdgeEstimator::Taylor)
            edge = one_step(field, scene, settings, i);
        else if (settings.edges != EdgeEstimator::Off)
            edge = find_surfel(field, scene, i, settings.edges == EdgeEstimator::Cubic);
        else if (scene.light)
            edge = normal_only(voxel_gradient(field, i));
        return quantised ? quantise(edge) : edge;
    });
}

VoxelEdge finished_face(const Field& field, const ScaledScene& scene, const Settings& settings,
                        const std::vector<VoxelEdge>& edges, const glm::ivec3& i, int m) {
    const bool is_translucent = scene.is_translucent[static_cast<std::size_t>(m)];
    VoxelEdge face = fit_face(field, scene, edges, i, m);
    face.deepest = is_translucent ? 0 : kFaceDepth;
    const bool near = face.has_edge && std::abs(face.D) <= edge_reach(settings);
    if (near && (!is_translucent || std::abs(face.D) < kKernelRadius)) return face;
    if (scene.material(field.at(i)) != m) return carries_nothing();
    VoxelEdge plain = normal_only(field_gradient(field, i));
    if (!near) return plain;
    // The face is beyond the kernel's radius and does not cut it, but its normal at the voxel, n - D H n, still lights
    // it. `steep` blends that with the field's own normal.
    const glm::dvec3 under = face.n - face.D * (face.bending * face.n);
    const glm::dvec3 outward = (face.upper ? -1.0 : 1.0) * under / std::max(glm::length(under), 1e-6);
    const glm::dvec3 lit = glm::mix(outward, plain.n, plain.has_normal ? face.steep : 0);
    if (!(glm::dot(lit, lit) > 1e-6)) return plain;
    plain.n = glm::normalize(lit);
    plain.has_normal = true;
    return plain;
}

std::vector<VoxelEdge> finish_edges(const Field& field, const ScaledScene& scene, const Settings& settings,
                                    const std::vector<VoxelEdge>& edges) {
    return per_drawn_voxel(field, scene, [&](const glm::ivec3& i) {
        if (!draws_faces(settings)) return edges[field.offset(i)];
        return finished_face(field, scene, settings, edges, i, scene.material(field.at(i)));
    });
}

std::vector<CarriedEdge> voxels_beside(const Field& field, const ScaledScene& scene) {
    std::vector<CarriedEdge> carried;
    for (std::size_t at = 0; at < field.values.size(); ++at) {
        const glm::ivec3 i = field.voxel(at);
        const auto [least, most] = values_around(field, i);
        const int own = scene.material(field.at(i)), last = scene.material(most);
        int first = scene.material(least);
        // Matter of a missing sample's own material is not there.
        if (field.has_data(at) && least < 0) first = std::min(first + 1, scene.material(least_data_around(field, i)));
        for (int m = first; m <= last; ++m)
            if (m != own && scene.is_translucent[static_cast<std::size_t>(m)]) carried.push_back({at, m, {}});
    }
    return carried;
}

void finish_carried(const Field& field, const ScaledScene& scene, const Settings& settings,
                    const std::vector<VoxelEdge>& edges, std::vector<CarriedEdge>& carried) {
    parallel_for(static_cast<int>(carried.size()), [&](int begin, int end) {
        for (int k = begin; k < end; ++k) {
            CarriedEdge& c = carried[static_cast<std::size_t>(k)];
            c.edge = finished_face(field, scene, settings, edges, field.voxel(c.voxel), c.material);
        }
    });
}

VoxelEdge quantise(const VoxelEdge& edge) {
    VoxelEdge stored = edge;
    if (edge.has_normal) stored.n = through_octahedron(edge.n);
    stored.D = 4 * snorm16(edge.D / 4);
    stored.bending = quantise_bending(edge.bending);
    if (edge.crease.D < kInfinity) stored.crease = {through_octahedron(edge.crease.n), 4 * snorm16(edge.crease.D / 4)};
    if (edge.corner.D < kInfinity)
        stored.corner = square_to(stored.n, stored.crease.n, std::round(edge.corner.D / 4 * 8190) / 8190 * 4,
                                  glm::dot(glm::cross(edge.n, edge.crease.n), edge.corner.n) < 0);
    stored.D2 = edge.D2 >= 4 ? kInfinity : std::round(std::max(edge.D2, 0.0) / 4 * 1022) / 1022 * 4;
    return stored;
}

}  // namespace edgesplat::reference

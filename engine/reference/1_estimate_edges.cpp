#include "engine/reference/1_estimate_edges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "engine/reference/faces.h"
#include "engine/reference/field_geometry.h"
#include "engine/volume/parallel.h"
#include "shaders/shared/limits.h"

namespace edgesplat::reference {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

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

VoxelEdge::Crease square_to(const glm::dvec3& n, const glm::dvec3& crease, double distance, bool turned) {
    return {(turned ? -1.0 : 1.0) * glm::normalize(glm::cross(n, crease)), distance};
}

VoxelEdge find_surfel(const Field& field, const ScaledScene& scene, const glm::ivec3& i, bool cubic) {
    geometry::FieldGeometry at(field, scene, {}, 0, cubic);
    const double f = field.at(i);
    const int m = scene.material(f);
    const geometry::Edge found = at.find_surfel(i, f, scene.lower(m), scene.upper(m), at.values_around(i));
    const glm::dvec3 out_of = at.border_beside(i);
    const bool border = at.is_cut_by_border(found, out_of);
    VoxelEdge edge = geometry::voxel_edge(border ? at.border_edge(out_of) : found);
    edge.border = border;
    return edge.has_edge ? edge : geometry::voxel_edge(geometry::normal_only(voxel_gradient(field, i)));
}

std::vector<VoxelEdge> estimate_edges(const Field& field, const ScaledScene& scene, const Settings& settings,
                                      bool quantised) {
    geometry::FieldGeometry at(field, scene);
    return per_drawn_voxel(field, scene, [&](const glm::ivec3& i) {
        VoxelEdge edge;
        const auto plain = [&] { return geometry::voxel_edge(geometry::normal_only(voxel_gradient(field, i))); };
        if (settings.edges == EdgeEstimator::Taylor) {
            const double f = field.at(i);
            const int m = scene.material(f);
            edge = geometry::voxel_edge(at.extrapolated_edge(f, voxel_gradient(field, i), scene.lower(m),
                                                             scene.upper(m), edge_reach(settings)));
            if (!edge.has_edge) edge = plain();
        } else if (settings.edges != EdgeEstimator::Off) {
            edge = find_surfel(field, scene, i, settings.edges == EdgeEstimator::Cubic);
        } else if (scene.light) {
            edge = plain();
        }
        return quantised ? quantise(edge) : edge;
    });
}

VoxelEdge finished_face(const Field& field, const ScaledScene& scene, const Settings& settings,
                        const std::vector<VoxelEdge>& edges, const glm::ivec3& i, int m) {
    const bool is_translucent = scene.is_translucent[static_cast<std::size_t>(m)];
    geometry::FieldGeometry at(field, scene, edges);
    VoxelEdge face = geometry::FieldGeometry::voxel_edge(
        at.finished_face(i, static_cast<std::uint32_t>(m), is_translucent, edge_reach(settings)));
    face.deepest = is_translucent ? 0 : FACE_DEPTH;
    return face;
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
    geometry::FieldGeometry samples(field, scene);
    for (std::size_t at = 0; at < field.values.size(); ++at) {
        const glm::ivec3 i = field.voxel(at);
        const glm::dvec2 around = samples.values_around(i);
        const int own = scene.material(field.at(i)), last = scene.material(around.y);
        int first = scene.material(around.x);
        // Matter of a missing sample's own material is not there.
        if (field.has_data(at) && around.x < 0)
            first = std::min(first + 1, scene.material(samples.least_data_around(i)));
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

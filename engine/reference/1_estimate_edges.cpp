#include "engine/reference/1_estimate_edges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "engine/reference/faces.h"
#include "engine/reference/parallel.h"
#include "footprints/kernel.h"

namespace edgesplat::reference {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Neighbours whose planes belong to the same piece of surface: normals within 37 degrees, foot points within reach.
constexpr double kSmoothAgreement = 0.8;
constexpr double kSmoothReach = 1.5;  // voxels

double reach_that_matters(const Settings& settings) {
    return edge_reach(settings);
}

/// The normal of a voxel without an edge.
VoxelEdge normal_only(const glm::dvec3& g) {
    VoxelEdge edge;
    const double length = glm::length(g);
    edge.has_normal = length >= kSmallestGradient;
    if (edge.has_normal) edge.n = -g / length;
    return edge;
}

/// `taylor` and `quadratic`: one step from the voxel's own value and derivatives.
VoxelEdge one_step(const Field& field, const ScaledScene& scene, const Settings& settings, const glm::ivec3& i) {
    const glm::dvec3 g = voxel_gradient(field, i);
    VoxelEdge edge = normal_only(g);
    if (!edge.has_normal) return edge;
    const double f = field.at(i);
    const double slope = glm::length(g);
    const int m = scene.material(f);
    const glm::dvec3 along = g / slope;
    const double bend =
        settings.edges == EdgeEstimator::Quadratic ? glm::dot(along, voxel_hessian(field, i) * along) : 0.0;
    const auto distance = [&](double q, double h) {
        if (std::isinf(q)) return kInfinity;
        return 2 * q / (slope + std::sqrt(std::max(slope * slope + 2 * h * q, 0.0)));
    };
    const double down = distance(f - scene.lower(m), -bend);
    const double up = distance(scene.upper(m) - f, bend);
    edge.upper = up < down;
    edge.D = std::min(up, down);
    edge.has_edge = edge.D <= reach_that_matters(settings);
    if (!edge.has_edge) return normal_only(g);
    if (edge.upper) edge.n = along;
    return edge;
}

/// Principal axis of the gradients around a voxel; none where they vanish.
std::optional<glm::dvec3> principal_axis(const Field& field, const glm::ivec3& i) {
    constexpr std::array<std::array<int, 3>, 7> around{
        {{0, 0, 0}, {-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}}};
    glm::dmat3 tensor(0);
    for (const auto& o : around) {
        const glm::dvec3 g = voxel_gradient(field, field.clamped(i + glm::ivec3(o[0], o[1], o[2])));
        tensor += glm::outerProduct(g, g);
    }
    if (!(tensor[0][0] + tensor[1][1] + tensor[2][2] >= kSmallestGradient * kSmallestGradient)) return std::nullopt;
    int largest = 0;
    for (int axis = 1; axis < 3; ++axis) {
        if (tensor[axis][axis] > tensor[largest][largest]) largest = axis;
    }
    glm::dvec3 axis = glm::normalize(tensor[largest]);
    for (int step = 0; step < 8; ++step)
        axis = glm::normalize(tensor * axis);
    return axis;
}

struct Hit {
    double t = 0;
    bool upper = false;
};

/// First place along x + t q where the field leaves [low, high).
std::optional<Hit> walk(const Field& field, const glm::dvec3& x, const glm::dvec3& q, double low, double high,
                        double own_value, bool cubic) {
    double t0 = 0;
    double f0 = own_value;
    for (int step = 1; step <= 6; ++step) {
        double t1 = 0.5 * step;
        double f1 = sample(field, x + t1 * q, cubic);
        if (f1 >= low && f1 < high) {
            t0 = t1;
            f0 = f1;
            continue;
        }
        const bool upper = f1 >= high;
        const double iso = upper ? high : low;
        const auto outside = [&](double f) { return upper ? f >= iso : f < iso; };
        const auto root = [&] { return t0 + (t1 - t0) * (f0 - iso) / (f0 - f1); };
        for (int i = 0; i < 3; ++i) {
            const double t = root();
            const double f = sample(field, x + t * q, cubic);
            (outside(f) ? t1 : t0) = t;
            (outside(f) ? f1 : f0) = f;
        }
        return Hit{root(), upper};
    }
    return std::nullopt;
}

/// From voxel i along q to where the volume ends, half a voxel beyond its outermost samples.
double way_out(const Field& field, const glm::ivec3& i, const glm::dvec3& q) {
    double t = kInfinity;
    for (int axis = 0; axis < 3; ++axis) {
        const double room = q[axis] > 0 ? field.dims[axis] - 0.5 - i[axis] : i[axis] + 0.5;
        t = std::min(t, room / std::max(std::abs(q[axis]), 1e-6));
    }
    return t;
}

/// `march` and `cubic`: both ways along the principal axis.
VoxelEdge march(const Field& field, const ScaledScene& scene, const Settings& settings, const glm::ivec3& i) {
    const bool cubic = settings.edges == EdgeEstimator::Cubic;
    const VoxelEdge none = normal_only(voxel_gradient(field, i));
    const auto axis = principal_axis(field, i);
    if (!axis) return none;
    const double f = field.at(i);
    const int m = scene.material(f);
    const glm::dvec3 x(i);

    std::array<std::optional<Hit>, 2> hits;
    std::array<VoxelEdge, 2> edges;
    for (int side = 0; side < 2; ++side) {
        const glm::dvec3 q = side == 0 ? -*axis : *axis;
        hits[side] = walk(field, x, q, scene.lower(m), scene.upper(m), f, cubic);
        if (!hits[side]) continue;
        const glm::dvec3 g = point_gradient(field, x + hits[side]->t * q, cubic);
        const double slope = glm::length(g);
        if (!(slope >= kSmallestGradient)) continue;
        VoxelEdge& edge = edges[side];
        edge.n = glm::dot(g, q) > 0 ? g / slope : -g / slope;
        const double agreement = glm::dot(edge.n, q);
        if (!(agreement >= 0.5)) continue;
        edge.has_edge = edge.has_normal = true;
        edge.D = hits[side]->t * agreement;
        edge.upper = hits[side]->upper;
    }
    if (!edges[0].has_edge && !edges[1].has_edge) return none;
    const int best = !edges[0].has_edge || (edges[1].has_edge && hits[1]->t < hits[0]->t) ? 1 : 0;
    VoxelEdge edge = edges[best];
    const double border = way_out(field, i, best == 0 ? *axis : -*axis);
    const double other = std::min(hits[1 - best] ? hits[1 - best]->t : kInfinity, border);
    if (other <= kEdgeReach) edge.D2 = other * std::abs(glm::dot(*axis, edge.n));
    return edge;
}

/// The plane of the neighbour whose foot point is nearest; `fallback` where none fits.
VoxelEdge adopted(const Field& field, const ScaledScene& scene, const Settings& settings,
                  const std::vector<VoxelEdge>& own, const glm::ivec3& i, const VoxelEdge& fallback) {
    const int m = scene.material(field.at(i));
    double nearest = reach_that_matters(settings);
    VoxelEdge best = fallback;
    bool found = false;
    for (int z = -2; z <= 2; ++z) {
        for (int y = -2; y <= 2; ++y) {
            for (int x = -2; x <= 2; ++x) {
                const glm::ivec3 offset(x, y, z);
                const glm::ivec3 at = i + offset;
                if (at != field.clamped(at)) continue;
                const VoxelEdge& edge = own[field.offset(at)];
                if (!edge.has_edge || scene.material(field.at(at)) != m) continue;
                const glm::dvec3 foot = glm::dvec3(offset) + edge.D * edge.n;  // relative to voxel i
                const double away = glm::length(foot);
                if (!(away < nearest)) continue;
                nearest = away;
                best = edge;
                best.D = glm::dot(edge.n, foot);
                best.D2 = std::max(edge.D + edge.D2 - best.D, 0.0);
                best.adopted = true;
                found = true;
            }
        }
    }
    return found && best.D >= -0.5 ? best : fallback;
}

struct SurfaceAround {
    /// Mean difference between a voxel's plane and its neighbours' planes on the same piece of surface. The chord
    /// between two foot points of a sphere is at right angles to the mean of their normals, so curvature does not bias
    /// it.
    double distance_correction = 0;
    double curvature = 0;  ///< of the sphere that fits the normals best, 1/voxel, positive where n points away from it
};

SurfaceAround surface_around(const Field& field, const ScaledScene& scene, const std::vector<VoxelEdge>& edges,
                             const glm::ivec3& i) {
    const VoxelEdge& edge = edges[field.offset(i)];
    // The edge belongs to an iso-value; both of its sides look for it, and err in opposite directions.
    const auto iso_of = [](const VoxelEdge& e, int material) { return e.upper ? material : material - 1; };
    const int m = scene.material(field.at(i));
    double sum = 0;
    double weights = 1;
    double turned = 0;
    double apart = 0;
    for (int z = -1; z <= 1; ++z) {
        for (int y = -1; y <= 1; ++y) {
            for (int x = -1; x <= 1; ++x) {
                const glm::ivec3 offset(x, y, z);
                const glm::ivec3 at = i + offset;
                if (offset == glm::ivec3(0) || at != field.clamped(at)) continue;
                const VoxelEdge& other = edges[field.offset(at)];
                if (!other.has_edge || other.adopted) continue;
                if (iso_of(other, scene.material(field.at(at))) != iso_of(edge, m)) continue;
                const glm::dvec3 n = other.upper == edge.upper ? other.n : -other.n;
                if (!(glm::dot(n, edge.n) >= kSmoothAgreement)) continue;
                const glm::dvec3 between = glm::dvec3(offset) + other.D * other.n - edge.D * edge.n;
                const double apart2 = glm::dot(between, between);
                if (!(apart2 < kSmoothReach * kSmoothReach)) continue;
                sum += 0.5 * glm::dot(edge.n + n, between);
                weights += 1;
                turned += glm::dot(n - edge.n, between);
                apart += apart2;
            }
        }
    }
    return {sum / weights, apart > 0 ? turned / apart : 0};
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

std::vector<VoxelEdge> estimate_own_edges(const Field& field, const ScaledScene& scene, const Settings& settings) {
    return per_drawn_voxel(field, scene, [&](const glm::ivec3& i) {
        switch (settings.edges) {
            case EdgeEstimator::Off:
                return scene.light ? normal_only(voxel_gradient(field, i)) : VoxelEdge{};
            case EdgeEstimator::Taylor:
            case EdgeEstimator::Quadratic:
                return one_step(field, scene, settings, i);
            case EdgeEstimator::March:
            case EdgeEstimator::Cubic:
                break;
        }
        if (draws_faces(settings)) return find_surfel(field, scene, i, settings.edges == EdgeEstimator::Cubic);
        return march(field, scene, settings, i);
    });
}

std::vector<VoxelEdge> adopt_edges(const Field& field, const ScaledScene& scene, const Settings& settings,
                                   const std::vector<VoxelEdge>& own) {
    return per_drawn_voxel(field, scene, [&](const glm::ivec3& i) {
        VoxelEdge edge = own[field.offset(i)];
        if (!edge.has_edge && marches(settings.edges) && !draws_faces(settings))
            edge = adopted(field, scene, settings, own, i, edge);
        return edge;
    });
}

std::vector<VoxelEdge> smooth_edges(const Field& field, const ScaledScene& scene, const Settings& settings,
                                    const std::vector<VoxelEdge>& edges) {
    const bool marched = marches(settings.edges);
    const bool curved = settings.edge_shape == EdgeShape::Curved && settings.warp == WarpFamily::Edge;
    return per_drawn_voxel(field, scene, [&](const glm::ivec3& i) {
        VoxelEdge edge = edges[field.offset(i)];
        if (draws_faces(settings)) {
            edge = fit_face(field, scene, edges, i);
            return edge.has_edge && std::abs(edge.D) <= edge_reach(settings) ? edge
                                                                             : normal_only(voxel_gradient(field, i));
        }
        if (!edge.has_edge) return edge;
        if (marched || curved) {
            const SurfaceAround around = surface_around(field, scene, edges, i);
            if (marched) {
                edge.D += around.distance_correction;
                edge.D2 -= around.distance_correction;
            }
            if (curved) {
                // Nor must the centre lie between the voxel and its edge.
                const double most = std::min(most_curved(settings), 0.95 / std::max(std::abs(edge.D), 0.1));
                edge.curvature = std::clamp(around.curvature, -most, most);
            }
        }
        if (!(std::abs(edge.D) <= reach_that_matters(settings))) {
            edge.has_edge = edge.adopted = edge.upper = false;
            edge.D = edge.curvature = 0;
            edge.D2 = kInfinity;
        }
        return edge;
    });
}

std::vector<VoxelEdge> estimate_edges(const Field& field, const ScaledScene& scene, const Settings& settings,
                                      bool quantised) {
    std::vector<VoxelEdge> own = estimate_own_edges(field, scene, settings);
    if (quantised) std::transform(own.begin(), own.end(), own.begin(), quantise);
    std::vector<VoxelEdge> edges = adopt_edges(field, scene, settings, own);
    if (quantised) std::transform(edges.begin(), edges.end(), edges.begin(), quantise);
    return edges;
}

VoxelEdge quantise(const VoxelEdge& edge) {
    VoxelEdge stored = edge;
    if (edge.has_normal) stored.n = through_octahedron(edge.n);
    stored.D = 4 * snorm16(edge.D / 4);
    stored.bending = quantise_bending(edge.bending);
    stored.weight = std::round(std::min(edge.weight / 4, 1.0) * 65535) / 65535 * 4;
    stored.D2 = edge.D2 >= 4 ? kInfinity : std::round(std::max(edge.D2, 0.0) / 4 * 1022) / 1022 * 4;
    return stored;
}

}  // namespace edgesplat::reference

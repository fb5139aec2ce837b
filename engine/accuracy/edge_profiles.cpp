#include "engine/accuracy/edge_profiles.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "engine/accuracy/metrics.h"
#include "engine/scene/transfer_function.h"
#include "engine/volume/parallel.h"

namespace edgesplat::accuracy {
namespace {

constexpr double kRooms[] = {3, 2, 1.5};  ///< voxels, in the order in which they are tried
constexpr double kBorderDistance = 3;     ///< voxels

/// The numerical gradient of the signed distance; 0 where it has none.
glm::dvec3 outwards(const AnalyticScene& scene, const glm::dvec3& x) {
    constexpr double kDelta = 1e-4;
    glm::dvec3 g(0);
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 step(0);
        step[axis] = kDelta;
        g[axis] = scene.signed_distance(x + step) - scene.signed_distance(x - step);
    }
    const double length = glm::length(g);
    return length > 0 ? g / length : glm::dvec3(0);
}

/// Whether the distance along the normal is the distance to this surface, up to `room` voxels to both sides.
bool undisturbed(const AnalyticScene& scene, const SurfacePoint& point, double room) {
    for (double s = -room; s <= room; s += 0.25)
        if (std::abs(scene.signed_distance(point.position + s * point.axis) - s) > 0.02) return false;
    return true;
}

/// A function of a position near the profile of a point: the sum of the kernels of all voxels inside.
std::function<double(const glm::dvec3&)> two_tone(const reference::PreparedVolume& prepared,
                                                  const reference::Footprints& footprints, const SurfacePoint& point,
                                                  const ProfileRange& range) {
    struct Splat {
        reference::VoxelEdge edge;
        glm::dvec3 center;
        double reach;
    };
    const reference::Field field = prepared.field();
    const double reach = footprints.farthest_reach() + range.reach * glm::length(point.axis);
    std::vector<Splat> splats;
    const auto add = [&](const reference::VoxelEdge& edge, const glm::dvec3& center) {
        splats.push_back({edge, center, footprints.reach(edge)});
    };
    const glm::ivec3 low = glm::max(glm::ivec3(glm::ceil(point.position - reach)), glm::ivec3(0));
    const glm::ivec3 high = glm::min(glm::ivec3(glm::floor(point.position + reach)), field.dims - 1);
    for (int z = low.z; z <= high.z; ++z) {
        for (int y = low.y; y <= high.y; ++y) {
            for (int x = low.x; x <= high.x; ++x) {
                const std::size_t i = field.offset({x, y, z});
                for (const reference::CarriedEdge& c : prepared.carried_by(i))
                    if (c.material >= 1 && c.edge.D > -kKernelRadius) add(c.edge, {x, y, z});
                if (prepared.scaled_scene().material(static_cast<double>(field.values[i])) < 1) continue;
                add(prepared.edges()[i], {x, y, z});
            }
        }
    }
    return [&footprints, splats = std::move(splats)](const glm::dvec3& p) {
        double sum = 0;
        for (const Splat& splat : splats) {
            const glm::dvec3 r = p - splat.center;
            if (glm::dot(r, r) < splat.reach * splat.reach) sum += footprints.at_point(splat.edge, r);
        }
        return sum;
    };
}

SurfacePoints points_with_room(const AnalyticScene& scene, int count, double room) {
    SurfacePoints result;
    result.room = room;
    std::mt19937 random(20);
    const auto uniform = [&] { return random() / 4294967296.0; };
    const glm::dvec3 top(scene.dims - 1);
    for (int trial = 0; trial < 400 * count && static_cast<int>(result.points.size()) < count; ++trial) {
        const double a = uniform(), b = uniform(), c = uniform();  // sets the order of the calls
        SurfacePoint point{glm::dvec3(a, b, c) * top, {}};
        // Only starts near the surface count, so that the points are spread evenly.
        if (std::abs(scene.signed_distance(point.position)) > 1) continue;
        for (int i = 0; i < 8; ++i)
            point.position -= scene.signed_distance(point.position) * outwards(scene, point.position);
        point.axis = outwards(scene, point.position);
        if (std::abs(scene.signed_distance(point.position)) > 1e-6 || point.axis == glm::dvec3(0)) continue;
        if (glm::any(glm::lessThan(point.position, glm::dvec3(kBorderDistance))) ||
            glm::any(glm::greaterThan(point.position, top - kBorderDistance)))
            ++result.near_border;
        else if (!undisturbed(scene, point, room))
            ++result.disturbed;
        else
            result.points.push_back(point);
    }
    return result;
}

}  // namespace

SurfacePoints surface_points(const AnalyticScene& scene, int count) {
    SurfacePoints result;
    for (const double room : kRooms) {
        result = points_with_room(scene, count, room);
        if (4 * static_cast<int>(result.points.size()) >= count) break;
    }
    return result;
}

namespace {

/// `values_at(point)` returns the profile of that point as a function of the position.
template <typename ValuesAt>
EdgeFigures figures_of(std::span<const SurfacePoint> points, const ProfileRange& range, const ValuesAt& values_at) {
    std::vector<std::optional<ProfileEdge>> edges(points.size());
    const int half = static_cast<int>(std::lround(range.reach / range.step));
    parallel_for(static_cast<int>(points.size()), [&](int begin, int end) {
        for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
            const auto value_at = values_at(points[i]);
            std::vector<double> profile;
            for (int k = -half; k <= half; ++k)
                profile.push_back(value_at(points[i].position + k * range.step * points[i].axis));
            edges[i] = profile_edge(profile, -range.reach, range.step);
        }
    });
    EdgeFigures figures;
    for (const auto& edge : edges) {
        if (!edge) {
            ++figures.missed;
            continue;
        }
        ++figures.measured;
        figures.rise_mean += edge->rise;
        figures.rise_max = std::max(figures.rise_max, edge->rise);
        figures.location_mean += std::abs(edge->location);
        figures.location_max = std::max(figures.location_max, std::abs(edge->location));
        figures.bias += edge->location;
    }
    if (figures.measured > 0)
        for (double* mean : {&figures.rise_mean, &figures.location_mean, &figures.bias})
            *mean /= figures.measured;
    return figures;
}

}  // namespace

EdgeFigures edge_figures(const reference::PreparedVolume& prepared, std::span<const SurfacePoint> points,
                         const ProfileRange& range) {
    Settings settings = prepared.settings();
    settings.footprints = FootprintMode::Procedural;  // the table has no values at points
    const reference::Footprints footprints(settings, table_depth(prepared.scene(), prepared.volume().geometry));
    return figures_of(points, range,
                      [&](const SurfacePoint& point) { return two_tone(prepared, footprints, point, range); });
}

EdgeFigures ray_edge_figures(const Volume& volume, double iso, std::span<const SurfacePoint> points,
                             const ProfileRange& range) {
    const reference::Field field{volume.geometry.dims, volume.values, {}};
    return figures_of(points, range, [&](const SurfacePoint&) {
        return [&](const glm::dvec3& p) { return reference::sample(field, p) >= iso ? 1.0 : 0.0; };
    });
}

}  // namespace edgesplat::accuracy

#include "engine/volume/analytic_internal.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "engine/error.h"

namespace edgesplat {

namespace analytic {

Distance ball_distance(const glm::dvec3& p, double radius) {
    const double r = glm::length(p);
    return {r - radius, r > 0 ? p / r : glm::dvec3(1, 0, 0)};
}

Distance ring_distance(const glm::dvec3& p, double major_radius, double minor_radius) {
    const double r = std::hypot(p.x, p.y), away = r - major_radius, d = std::hypot(away, p.z);
    const glm::dvec3 radial = r > 0 ? glm::dvec3(p.x / r, p.y / r, 0) : glm::dvec3(1, 0, 0);
    return {d - minor_radius, d > 0 ? (away * radial + glm::dvec3(0, 0, p.z)) / d : radial};
}

Distance box_distance(const glm::dvec3& p, const glm::dvec3& half, double rounding) {
    const glm::dvec3 sign(p.x < 0 ? -1 : 1, p.y < 0 ? -1 : 1, p.z < 0 ? -1 : 1);
    const glm::dvec3 q = glm::abs(p) - (half - rounding);
    const glm::dvec3 beyond = glm::max(q, 0.0);
    const double outside = glm::length(beyond);
    if (outside > 0) return {outside - rounding, sign * beyond / outside};
    const int axis = q.x > q.y ? (q.x > q.z ? 0 : 2) : (q.y > q.z ? 1 : 2);
    glm::dvec3 gradient(0);
    gradient[axis] = sign[axis];
    return {q[axis] - rounding, gradient};
}

void check(const EdgeProfile& profile) {
    if (!(profile.inside > profile.outside))
        fail("edge profile: inside {} must be above outside {}", profile.inside, profile.outside);
    if (!profile.binary && !(profile.blur > 0)) fail("edge profile: blur {} must be above 0", profile.blur);
}

AnalyticScene with_profile(std::string name, const glm::ivec3& dims, const EdgeProfile& profile) {
    check(profile);
    AnalyticScene scene;
    scene.name = std::move(name);
    scene.dims = dims;
    scene.iso_values = {profile.iso_value()};
    scene.rise = profile.inside - profile.outside;
    return scene;
}

AnalyticScene solid(std::string name, const glm::ivec3& dims, const EdgeProfile& profile, DistanceFunction distance) {
    AnalyticScene scene = with_profile(std::move(name), dims, profile);
    const auto shared = std::make_shared<DistanceFunction>(std::move(distance));
    const double rise = scene.rise;
    scene.signed_distance = [shared](const glm::dvec3& x) { return (*shared)(x).value; };
    if (profile.binary) {
        scene.value = [shared, profile](const glm::dvec3& x) {
            return (*shared)(x).value <= 0 ? profile.inside : profile.outside;
        };
        scene.gradient = [](const glm::dvec3&) { return glm::dvec3(0); };
    } else {
        scene.value = [shared, profile, rise](const glm::dvec3& x) {
            return profile.outside + rise * step(-(*shared)(x).value, profile.blur);
        };
        scene.gradient = [shared, profile, rise](const glm::dvec3& x) {
            const auto d = (*shared)(x);
            return -rise * bell(d.value, profile.blur) * d.gradient;
        };
    }
    return scene;
}

glm::dvec3 unit(const glm::dvec3& v, const char* what) {
    const double length = glm::length(v);
    if (!(length > 0) || !std::isfinite(length)) fail("{}: ({}, {}, {}) has no direction", what, v.x, v.y, v.z);
    return v / length;
}

}  // namespace analytic

namespace {

using namespace analytic;

// Cube with a hole along z, exact everywhere: beyond the hole's opening the nearest point is on its rim.
Distance cube_hole_distance(const glm::dvec3& p, double half, double hole) {
    const double r = std::hypot(p.x, p.y);
    const glm::dvec3 radial = r > 0 ? glm::dvec3(p.x / r, p.y / r, 0) : glm::dvec3(1, 0, 0);
    const Distance wall{hole - r, -radial};
    const double above = std::abs(p.z) - half;
    if (r < hole && above > 0) {
        const double d = std::hypot(wall.value, above);
        return {d, (wall.value * wall.gradient + above * glm::dvec3(0, 0, p.z < 0 ? -1 : 1)) / d};
    }
    const Distance cube = box_distance(p, glm::dvec3(half), 0);
    return cube.value <= 0 && wall.value > cube.value ? wall : cube;
}

struct Slab {
    glm::dvec3 normal;
    double position;  // along the normal
    double half;      // half thickness
};

AnalyticScene slabs(std::string name, const glm::ivec3& dims, std::vector<Slab> walls, const EdgeProfile& profile) {
    AnalyticScene scene = with_profile(std::move(name), dims, profile);
    const double rise = scene.rise;
    const auto shared = std::make_shared<std::vector<Slab>>(std::move(walls));
    scene.signed_distance = [shared](const glm::dvec3& x) {
        double nearest = INFINITY;
        for (const auto& wall : *shared)
            nearest = std::min(nearest, std::abs(glm::dot(wall.normal, x) - wall.position) - wall.half);
        return nearest;
    };
    if (profile.binary) {
        scene.value = [distance = scene.signed_distance, profile](const glm::dvec3& x) {
            return distance(x) <= 0 ? profile.inside : profile.outside;
        };
        scene.gradient = [](const glm::dvec3&) { return glm::dvec3(0); };
        return scene;
    }
    scene.value = [shared, profile, rise](const glm::dvec3& x) {
        double sum = 0;
        for (const auto& wall : *shared) {
            const double t = glm::dot(wall.normal, x) - wall.position;
            sum += step(t + wall.half, profile.blur) - step(t - wall.half, profile.blur);
        }
        return profile.outside + rise * sum;
    };
    scene.gradient = [shared, profile, rise](const glm::dvec3& x) {
        glm::dvec3 sum(0);
        for (const auto& wall : *shared) {
            const double t = glm::dot(wall.normal, x) - wall.position;
            sum += (bell(t + wall.half, profile.blur) - bell(t - wall.half, profile.blur)) * wall.normal;
        }
        return rise * sum;
    };
    return scene;
}

}  // namespace

// Walls of 0.5 to 4 voxels, slightly tilted so that they cut the grid at varying positions.
AnalyticScene analytic::plates() {
    const auto normal = glm::normalize(glm::dvec3(1, 0.2, 0.1));
    const glm::ivec3 dims(96, 48, 48);
    std::vector<Slab> walls;
    double x = 14;
    for (const double thickness : {0.5, 1.0, 1.5, 2.0, 3.0, 4.0}) {
        walls.push_back({normal, glm::dot(normal, glm::dvec3(x, 23.5, 23.5)), thickness / 2});
        x += 13.6;
    }
    return slabs("plates", dims, std::move(walls), {});
}

AnalyticScene plane_scene(const glm::ivec3& dims, const glm::dvec3& normal, const glm::dvec3& point,
                          const EdgeProfile& profile) {
    const auto n = unit(normal, "plane normal");
    return solid("plane", dims, profile, [n, point](const glm::dvec3& x) {
        return Distance{glm::dot(n, x - point), n};
    });
}

AnalyticScene sphere_scene(const glm::ivec3& dims, const glm::dvec3& center, double radius,
                           const EdgeProfile& profile) {
    if (!(radius > 0)) fail("sphere: radius {} must be above 0", radius);
    return solid("sphere", dims, profile,
                 [center, radius](const glm::dvec3& x) { return ball_distance(x - center, radius); });
}

AnalyticScene torus_scene(const glm::ivec3& dims, const glm::dvec3& center, double major_radius, double minor_radius,
                          const EdgeProfile& profile) {
    if (!(minor_radius > 0 && major_radius > minor_radius))
        fail("torus: radii {} and {}: expected 0 < minor < major", major_radius, minor_radius);
    return solid("torus", dims, profile,
                 [=](const glm::dvec3& x) { return ring_distance(x - center, major_radius, minor_radius); });
}

AnalyticScene slab_scene(const glm::ivec3& dims, const glm::dvec3& normal, const glm::dvec3& point, double thickness,
                         const EdgeProfile& profile) {
    if (!(thickness > 0)) fail("slab: thickness {} must be above 0", thickness);
    const auto n = unit(normal, "slab normal");
    return slabs("slab", dims, {{n, glm::dot(n, point), thickness / 2}}, profile);
}

AnalyticScene cube_hole_scene(const glm::ivec3& dims, double side, double hole_radius, const EdgeProfile& profile) {
    if (!(hole_radius > 0 && hole_radius < side / 2))
        fail("cube-hole: hole radius {} must be above 0 and below half the side {}", hole_radius, side);
    const auto center = middle(dims);
    return solid("cube-hole", dims, profile,
                 [=](const glm::dvec3& x) { return cube_hole_distance(x - center, side / 2, hole_radius); });
}

}  // namespace edgesplat

#include "engine/volume/analytic_volumes.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <memory>
#include <utility>

#include "engine/error.h"

namespace edgesplat {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kSqrt2 = 1.41421356237309504880;
constexpr std::array<std::string_view, 8> kNames = {"cube-hole", "sphere",         "torus",   "plates",
                                                    "plane",     "marschner-lobb", "orbital", "phantom"};

// Distance to a surface and its derivative; the derivative has unit length almost everywhere.
struct Distance {
    double value;
    glm::dvec3 gradient;
};
using DistanceFunction = std::function<Distance(const glm::dvec3&)>;

// Integral of a Gaussian of standard deviation `sd` from -infinity to t, and its derivative.
double step(double t, double sd) {
    return 0.5 * std::erfc(-t / (kSqrt2 * sd));
}
double bell(double t, double sd) {
    return std::exp(-0.5 * t * t / (sd * sd)) / (sd * std::sqrt(2 * kPi));
}

void check(const EdgeProfile& profile) {
    if (!(profile.inside > profile.outside))
        fail("edge profile: inside {} must be above outside {}", profile.inside, profile.outside);
    if (!profile.binary && !(profile.blur > 0)) fail("edge profile: blur {} must be above 0", profile.blur);
}

AnalyticScene solid(std::string name, const glm::ivec3& dims, const EdgeProfile& profile, DistanceFunction distance) {
    check(profile);
    AnalyticScene scene;
    scene.name = std::move(name);
    scene.dims = dims;
    scene.iso_values = {profile.iso_value()};
    const auto shared = std::make_shared<DistanceFunction>(std::move(distance));
    const double rise = profile.inside - profile.outside;
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

glm::dvec3 middle(const glm::ivec3& dims) {
    return (glm::dvec3(dims) - 1.0) * 0.5;
}

// Cube with a hole along z, exact everywhere: beyond the hole's mouth the nearest solid is its rim.
Distance cube_hole_distance(const glm::dvec3& p, double half, double hole) {
    const glm::dvec3 sign(p.x < 0 ? -1 : 1, p.y < 0 ? -1 : 1, p.z < 0 ? -1 : 1);
    const auto q = glm::abs(p) - half;
    const double r = std::hypot(p.x, p.y);
    const glm::dvec3 radial = r > 0 ? glm::dvec3(p.x / r, p.y / r, 0) : glm::dvec3(1, 0, 0);
    const Distance wall{hole - r, -radial};
    if (r < hole && q.z > 0) {
        const double d = std::hypot(wall.value, q.z);
        return {d, (wall.value * wall.gradient + q.z * glm::dvec3(0, 0, sign.z)) / d};
    }
    const auto beyond = glm::max(q, 0.0);
    const double outside = glm::length(beyond);
    if (outside > 0) return {outside, sign * beyond / outside};
    const int axis = q.x > q.y ? (q.x > q.z ? 0 : 2) : (q.y > q.z ? 1 : 2);
    glm::dvec3 gradient(0);
    gradient[axis] = sign[axis];
    return wall.value > q[axis] ? wall : Distance{q[axis], gradient};
}

struct Slab {
    glm::dvec3 normal;
    double position;  // along the normal
    double half;      // half thickness
};

AnalyticScene slabs(std::string name, const glm::ivec3& dims, std::vector<Slab> walls, const EdgeProfile& profile) {
    check(profile);
    AnalyticScene scene;
    scene.name = std::move(name);
    scene.dims = dims;
    scene.iso_values = {profile.iso_value()};
    const double rise = profile.inside - profile.outside;
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

// Walls of 0.5 to 4 voxels, leaning a little so that they cut the grid everywhere else.
AnalyticScene plates() {
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

// Marschner and Lobb 1994: fM = 6, alpha = 0.25, on [-1, 1]^3.
AnalyticScene marschner_lobb() {
    constexpr double fm = 6, alpha = 0.25, scale = 2.0 / 40;
    AnalyticScene scene;
    scene.name = "marschner-lobb";
    scene.dims = glm::ivec3(41);
    scene.iso_values = {0.5};
    scene.value = [](const glm::dvec3& x) {
        const auto p = x * scale - 1.0;
        const double radial = std::cos(2 * kPi * fm * std::cos(kPi * std::hypot(p.x, p.y) / 2));
        return (1 - std::sin(kPi * p.z / 2) + alpha * (1 + radial)) / (2 * (1 + alpha));
    };
    scene.gradient = [](const glm::dvec3& x) {
        const auto p = x * scale - 1.0;
        const double r = std::hypot(p.x, p.y), inner = kPi * r / 2;
        const double by_r = std::sin(2 * kPi * fm * std::cos(inner)) * 2 * kPi * fm * std::sin(inner) * kPi / 2;
        const glm::dvec2 radial = r > 0 ? glm::dvec2(p.x, p.y) / r : glm::dvec2(0);
        const double factor = scale / (2 * (1 + alpha));
        return glm::dvec3(alpha * by_r * radial.x, alpha * by_r * radial.y, -std::cos(kPi * p.z / 2) * kPi / 2) *
               factor;
    };
    return scene;
}

// Density of the 3d (m = 0) state, largest value 1: two lobes along z and a ring.
AnalyticScene orbital() {
    constexpr double scale = 18.0 / 31.5;  // Bohr radii per voxel
    static const double norm = std::exp(4.0) / 5184;
    AnalyticScene scene;
    scene.name = "orbital";
    scene.iso_values = {0.04, 0.15};
    scene.value = [](const glm::dvec3& x) {
        const auto p = (x - 31.5) * scale;
        const double r2 = glm::dot(p, p), angular = 3 * p.z * p.z - r2;
        return norm * angular * angular * std::exp(-2.0 / 3.0 * std::sqrt(r2));
    };
    scene.gradient = [](const glm::dvec3& x) {
        const auto p = (x - 31.5) * scale;
        const double r = glm::length(p), angular = 3 * p.z * p.z - r * r;
        const glm::dvec3 by_angle(-2 * p.x, -2 * p.y, 4 * p.z);
        const auto outward = r > 0 ? p / r : glm::dvec3(0);
        return norm * std::exp(-2.0 / 3.0 * r) * scale *
               (2 * angular * by_angle - 2.0 / 3.0 * angular * angular * outward);
    };
    return scene;
}

struct Ellipsoid {
    glm::dvec3 center, radii;
    double value;  // HU
};

// A head in a 96 x 112 x 96 grid, nose towards +y, up +z; each part is laid over those before it.
constexpr std::array<Ellipsoid, 17> kHead = {{
    {{47.5, 52, 48}, {36, 44, 42}, 40},       // skin and muscle
    {{47.5, 98, 36}, {6, 9, 8}, 40},          // nose
    {{47.5, 50, 52}, {32.5, 39.5, 36}, 900},  // skull
    {{47.5, 49, 54}, {29.5, 36, 32}, 35},     // brain
    {{42, 50, 58}, {4, 13, 6}, 8},            // ventricles
    {{53, 50, 58}, {4, 13, 6}, 8},
    {{47.5, 80, 34}, {14, 17, 15}, 500},   // facial bone
    {{43, 82, 34}, {3.2, 19, 10}, -1000},  // nasal passages, a septum of 2.6 voxels between them
    {{52, 82, 34}, {3.2, 19, 10}, -1000},
    {{40.6, 80, 33}, {1.2, 10, 3.5}, 60},  // turbinates
    {{54.4, 80, 33}, {1.2, 10, 3.5}, 60},
    {{34, 78, 32}, {4.5, 8, 7}, -1000},  // maxillary sinuses
    {{61, 78, 32}, {4.5, 8, 7}, -1000},
    {{47.5, 86, 55}, {7, 3.5, 5}, -1000},  // frontal sinus
    {{47.5, 58, 26}, {6, 7, 18}, -1000},   // pharynx
    {{14, 48, 42}, {7, 2.5, 2.5}, -1000},  // ear canals
    {{81, 48, 42}, {7, 2.5, 2.5}, -1000},
}};

AnalyticScene phantom() {
    constexpr double blur = 0.7;
    const auto evaluate = [](const glm::dvec3& x) {
        double value = -1000;
        glm::dvec3 gradient(0);
        for (const auto& part : kHead) {
            const auto p = (x - part.center) / part.radii;
            const double k = glm::length(p), size = std::cbrt(part.radii.x * part.radii.y * part.radii.z);
            const double s = (k - 1) * size;  // not a distance, but 0 on the surface and smooth
            if (s > 9 * blur) continue;
            const double share = step(-s, blur);
            const auto slope = k > 0 ? p / part.radii * (size / k) : glm::dvec3(0);
            gradient = gradient * (1 - share) - (part.value - value) * bell(s, blur) * slope;
            value += (part.value - value) * share;
        }
        return std::pair(value, gradient);
    };
    AnalyticScene scene;
    scene.name = "phantom";
    scene.dims = {96, 112, 96};
    scene.spacing = glm::dvec3(2);
    scene.iso_values = {-400, 300};
    scene.value = [evaluate](const glm::dvec3& x) { return evaluate(x).first; };
    scene.gradient = [evaluate](const glm::dvec3& x) { return evaluate(x).second; };
    scene.noise = 12;
    return scene;
}

// Nearly normal noise (sum of 12 uniforms) in integers, so that every machine makes the same.
double noise_of(std::uint64_t index, std::uint32_t seed) {
    std::uint64_t sum = 0;
    std::uint64_t state = (index + 1) * 0x9e3779b97f4a7c15ULL + seed * 0xd1b54a32d192ed03ULL;
    for (int i = 0; i < 3; ++i) {
        state += 0x9e3779b97f4a7c15ULL;
        std::uint64_t z = state;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
        z ^= z >> 31;
        sum += (z & 0xffff) + ((z >> 16) & 0xffff) + ((z >> 32) & 0xffff) + (z >> 48);
    }
    return static_cast<double>(sum) / 65536.0 - 6.0 * 65535.0 / 65536.0;
}

}  // namespace

std::span<const std::string_view> analytic_scene_names() {
    return kNames;
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
    return solid("sphere", dims, profile, [center, radius](const glm::dvec3& x) {
        const auto p = x - center;
        const double r = glm::length(p);
        return Distance{r - radius, r > 0 ? p / r : glm::dvec3(0)};
    });
}

AnalyticScene torus_scene(const glm::ivec3& dims, const glm::dvec3& center, double major_radius, double minor_radius,
                          const EdgeProfile& profile) {
    if (!(minor_radius > 0 && major_radius > minor_radius))
        fail("torus: radii {} and {}: expected 0 < minor < major", major_radius, minor_radius);
    return solid("torus", dims, profile, [=](const glm::dvec3& x) {
        const auto p = x - center;
        const double r = std::hypot(p.x, p.y), away = r - major_radius, d = std::hypot(away, p.z);
        const auto radial = r > 0 ? glm::dvec3(p.x / r, p.y / r, 0) : glm::dvec3(0);
        const auto gradient = d > 0 ? (away * radial + glm::dvec3(0, 0, p.z)) / d : glm::dvec3(0);
        return Distance{d - minor_radius, gradient};
    });
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

AnalyticScene analytic_scene(std::string_view name) {
    const glm::ivec3 cube(64);
    if (name == "cube-hole") return cube_hole_scene(glm::ivec3(20), 12, 3.5, {.binary = true});
    if (name == "sphere") return sphere_scene(cube, glm::dvec3(31.7, 31.4, 31.2), 20, {});
    if (name == "torus") return torus_scene({64, 64, 32}, glm::dvec3(31.6, 31.3, 15.4), 18, 7, {});
    if (name == "plates") return plates();
    if (name == "plane") return plane_scene(cube, {0.6, 0.3, 0.74}, glm::dvec3(31.6, 31.3, 31.4), {});
    if (name == "marschner-lobb") return marschner_lobb();
    if (name == "orbital") return orbital();
    if (name == "phantom") return phantom();
    fail("no built-in volume '{}'; there are {}", name, fmt::join(kNames, ", "));
}

AnalyticScene resized(const AnalyticScene& scene, const glm::ivec3& dims) {
    if (dims.x < 2 || dims.y < 2 || dims.z < 2 || scene.dims.x < 2 || scene.dims.y < 2 || scene.dims.z < 2)
        fail("{}: cannot be resized to {} x {} x {}: each must be at least 2", scene.name, dims.x, dims.y, dims.z);
    const auto factor = (glm::dvec3(scene.dims) - 1.0) / (glm::dvec3(dims) - 1.0);
    AnalyticScene result = scene;
    result.dims = dims;
    result.spacing = scene.spacing * factor;
    result.value = [f = scene.value, factor](const glm::dvec3& x) { return f(x * factor); };
    result.gradient = [f = scene.gradient, factor](const glm::dvec3& x) { return f(x * factor) * factor; };
    result.signed_distance = nullptr;
    if (scene.signed_distance && factor.x == factor.y && factor.y == factor.z)
        result.signed_distance = [f = scene.signed_distance, factor](const glm::dvec3& x) {
            return f(x * factor) / factor.x;
        };
    return result;
}

float sample_at(const AnalyticScene& scene, const glm::ivec3& voxel) {
    double value = scene.value(glm::dvec3(voxel));
    if (scene.noise > 0) {
        const auto dims = glm::u64vec3(scene.dims), at = glm::u64vec3(voxel);
        value += scene.noise * noise_of((at.z * dims.y + at.y) * dims.x + at.x, scene.noise_seed);
    }
    return static_cast<float>(value);
}

Volume sample(const AnalyticScene& scene) {
    Volume volume;
    volume.name = "builtin:" + scene.name;
    volume.stored_type = "float64";
    volume.geometry.dims = scene.dims;
    for (int axis = 0; axis < 3; ++axis) {
        if (scene.dims[axis] < 1 || scene.dims[axis] > 65535)
            fail("{}: dims {} x {} x {}: each must be 1 to 65535", scene.name, scene.dims.x, scene.dims.y,
                 scene.dims.z);
        volume.geometry.index_to_world_axes[axis][axis] = scene.spacing[axis];
    }
    if (volume.geometry.voxel_count() > std::size_t{1} << 31) fail("{}: more than 2^31 voxels", scene.name);
    volume.values.resize(volume.geometry.voxel_count());
    std::size_t index = 0;
    for (int z = 0; z < scene.dims.z; ++z)
        for (int y = 0; y < scene.dims.y; ++y)
            for (int x = 0; x < scene.dims.x; ++x)
                volume.values[index++] = sample_at(scene, {x, y, z});
    finish_volume(volume);
    return volume;
}

bool is_builtin(std::string_view path) {
    return path.starts_with("builtin:");
}

AnalyticScene builtin_scene(std::string_view path) {
    if (is_builtin(path)) path.remove_prefix(8);
    const auto colon = path.find(':');
    auto scene = analytic_scene(path.substr(0, colon));
    if (colon != std::string_view::npos) {
        const std::string_view text = path.substr(colon + 1);
        std::array<int, 3> dims{};
        int count = 0;
        const char* at = text.data();
        const char* const end = at + text.size();
        while (at < end && count < 3) {
            const auto [next, error] = std::from_chars(at, end, dims[static_cast<std::size_t>(count)]);
            if (error != std::errc()) break;
            ++count;
            at = next;
            if (at < end && *at == 'x' && count < 3 && at + 1 < end)
                ++at;
            else
                break;
        }
        if (at != end || (count != 1 && count != 3))
            fail("builtin:{}: '{}' is neither one number of voxels nor three like 64x48x32", path, text);
        scene = resized(scene, count == 1 ? glm::ivec3(dims[0]) : glm::ivec3(dims[0], dims[1], dims[2]));
    }
    return scene;
}

Volume builtin_volume(std::string_view path) {
    return sample(builtin_scene(path));
}

}  // namespace edgesplat

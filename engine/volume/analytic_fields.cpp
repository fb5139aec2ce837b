#include "engine/volume/analytic_internal.h"

#include <array>
#include <cmath>

namespace edgesplat::analytic {

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

namespace {

struct Ellipsoid {
    glm::dvec3 center, radii;
    double value;  // HU
};

// A head in a 96 x 112 x 96 grid, nose towards +y, up +z; later parts replace earlier ones.
constexpr std::array<Ellipsoid, 17> kHead = {{
    {{47.5, 52, 48}, {36, 44, 42}, 40},       // skin and muscle
    {{47.5, 98, 36}, {6, 9, 8}, 40},          // nose
    {{47.5, 50, 52}, {32.5, 39.5, 36}, 900},  // skull
    {{47.5, 49, 54}, {29.5, 36, 32}, 35},     // brain
    {{42, 50, 58}, {4, 13, 6}, 8},            // ventricles
    {{53, 50, 58}, {4, 13, 6}, 8},
    {{47.5, 80, 34}, {14, 17, 15}, 500},   // facial bone
    {{43, 82, 34}, {3.2, 19, 10}, -1000},  // nasal passages, separated by a septum of 2.6 voxels
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

}  // namespace

AnalyticScene phantom() {
    constexpr double blur = 0.7;
    const auto evaluate = [](const glm::dvec3& x) {
        double value = -1000;
        glm::dvec3 gradient(0);
        for (const auto& part : kHead) {
            const auto p = (x - part.center) / part.radii;
            const double k = glm::length(p), size = std::cbrt(part.radii.x * part.radii.y * part.radii.z);
            const double s = (k - 1) * size;  // not a distance, but smooth and 0 on the surface
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
    scene.rise = 1900;  // air to bone
    scene.noise = 12;
    return scene;
}

}  // namespace edgesplat::analytic

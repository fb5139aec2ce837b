// How sharp, how well placed and how even edges come out: the figures in docs/measured.md. Double-precision reference
// only, so they are the method's own errors, not a device's. Prints tables; takes minutes.
//   quality_study [planes] [walls] [unity] [estimates]
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "engine/reference/reference_renderer.h"
#include "footprints/kernel.h"

namespace {

using namespace edgesplat;
using reference::Output;
using reference::PreparedVolume;

constexpr double kPixelsPerVoxel = 40;
constexpr double kEyeDistance = 400;  // voxels: perspective bends a line of sight by 0.1 voxel at most
constexpr int kOrientations = 24;

struct Pose {
    glm::dvec3 n, across, along;  // orthonormal; n is the normal of the plane or plate
    glm::dvec3 shift;             // of its centre from the middle of the grid, within a voxel
};

std::vector<Pose> poses(int count) {
    std::mt19937 random(7);
    const auto uniform = [&] { return random() / 4294967296.0; };
    std::vector<Pose> list;
    for (int i = 0; i < count; ++i) {
        const double z = 2 * uniform() - 1;
        const double phi = 2 * std::numbers::pi * uniform();
        const double r = std::sqrt(1 - z * z);
        Pose pose;
        pose.n = {r * std::cos(phi), r * std::sin(phi), z};
        const glm::dvec3 other = std::abs(z) < 0.6 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
        const glm::dvec3 a = glm::normalize(glm::cross(pose.n, other));
        const glm::dvec3 b = glm::cross(pose.n, a);
        const double spin = 2 * std::numbers::pi * uniform();
        pose.across = std::cos(spin) * a + std::sin(spin) * b;
        pose.along = glm::cross(pose.n, pose.across);
        pose.shift = {uniform() - 0.5, uniform() - 0.5, uniform() - 0.5};
        list.push_back(pose);
    }
    return list;
}

template <typename Value>
Volume sampled(int size, const Value& value) {
    Volume volume;
    volume.geometry.dims = glm::ivec3(size);
    for (int z = 0; z < size; ++z) {
        for (int y = 0; y < size; ++y) {
            for (int x = 0; x < size; ++x)
                volume.values.push_back(static_cast<float>(value(glm::dvec3(x, y, z))));
        }
    }
    finish_volume(volume);
    return volume;
}

double step_up(double s, double sd) {
    return 0.5 * std::erfc(s / (sd * std::numbers::sqrt2));
}  // 1 where s << 0

Scene two_tone(double outside, double inside) {
    Scene scene;
    scene.iso_values = {0.5};
    scene.materials = {{{1, 1, 1}, outside}, {{1, 1, 1}, inside}};
    return scene;
}

/// Looks along `direction` at `target`; `right` is screen +x.
Camera camera_at(const glm::dvec3& target, const glm::dvec3& direction, const glm::dvec3& right, int height) {
    Camera camera;
    camera.eye = target - kEyeDistance * direction;
    camera.direction = direction;
    camera.up = glm::cross(right, direction);
    camera.fov_y = glm::degrees(2 * std::atan(height / kPixelsPerVoxel / 2 / kEyeDistance));
    return camera;
}

double mean(const std::vector<double>& v) {
    double sum = 0;
    for (const double x : v)
        sum += x;
    return v.empty() ? std::nan("") : sum / static_cast<double>(v.size());
}
double largest(const std::vector<double>& v) {
    return v.empty() ? std::nan("") : *std::max_element(v.begin(), v.end());
}

/// Where a profile that starts high first falls below `level`, in samples; NaN where it never does.
double first_below(const std::vector<double>& profile, double level) {
    for (std::size_t i = 1; i < profile.size(); ++i) {
        if (profile[i] < level && profile[i - 1] >= level) {
            return static_cast<double>(i - 1) + (profile[i - 1] - level) / (profile[i - 1] - profile[i]);
        }
    }
    return std::nan("");
}

struct Edges {
    std::vector<double> rise, location, overshoot;  // voxels, voxels, of the interior level
};

/// Adds the rise and place of one falling edge expected at sample `expected`.
void measure(const std::vector<double>& profile, double expected, Edges& edges) {
    const double low = first_below(profile, 0.1);
    // 90 % nearest before the 10 % point: ripple of the interior is not the edge.
    std::vector<double> back(profile.begin(),
                             profile.begin() + static_cast<std::ptrdiff_t>(std::isnan(low) ? 0 : std::ceil(low)));
    double high = std::nan("");
    for (std::size_t i = back.size(); i-- > 1;) {
        if (back[i - 1] >= 0.9 && back[i] < 0.9) {
            high = static_cast<double>(i - 1) + (back[i - 1] - 0.9) / (back[i - 1] - back[i]);
            break;
        }
    }
    const double half = first_below(profile, 0.5);
    if (!std::isnan(low) && !std::isnan(high)) edges.rise.push_back((low - high) / kPixelsPerVoxel);
    if (!std::isnan(half)) edges.location.push_back(std::abs(half - expected) / kPixelsPerVoxel);
    edges.overshoot.push_back(*std::max_element(profile.begin(), profile.end()) - 1);
}

struct Method {
    std::string name;
    Settings settings;
};

Settings with(EdgeEstimator edges, double k, WarpFamily family = WarpFamily::Edge,
              FootprintMode mode = FootprintMode::Procedural) {
    Settings s;
    s.edges = edges;
    s.edge_strength = k;
    s.warp = family;
    s.footprints = mode;
    return s;
}

std::vector<Method> methods() {
    std::vector<Method> list{{"off", with(EdgeEstimator::Off, 12)}};
    for (const auto e : {EdgeEstimator::Taylor, EdgeEstimator::Quadratic, EdgeEstimator::March, EdgeEstimator::Cubic}) {
        for (const double k : {8.0, 12.0, 14.0, 16.0}) {
            if (e != EdgeEstimator::March && k != 12) continue;
            list.push_back({fmt::format("{} k={}", name_of(e), k), with(e, k)});
        }
    }
    const auto march = EdgeEstimator::March;
    list.push_back({"march k=12 table", with(march, 12, WarpFamily::Edge, FootprintMode::Table)});
    list.push_back({"march k=12 table-lerp", with(march, 12, WarpFamily::Edge, FootprintMode::TableLerp)});
    list.push_back({"march k=12 warp2d", with(march, 12, WarpFamily::Edge, FootprintMode::Warp2d)});
    list.push_back({"march paper", with(march, 12, WarpFamily::Paper)});
    list.push_back({"taylor paper", with(EdgeEstimator::Taylor, 12, WarpFamily::Paper)});
    list.push_back({"taylor paper warp2d", with(EdgeEstimator::Taylor, 12, WarpFamily::Paper, FootprintMode::Warp2d)});
    return list;
}

/// Falling edges of a picture's rows, the interior at 1: divided by the same view of a solid block.
std::vector<std::vector<double>> profiles(const Image& tau, const Image& solid) {
    std::vector<std::vector<double>> rows;
    for (int y = 0; y < tau.height; ++y) {
        std::vector<double> row;
        for (int x = 0; x < tau.width; ++x) {
            row.push_back(static_cast<double>(tau.at(x, y, 0)) / static_cast<double>(solid.at(x, y, 0)));
        }
        rows.push_back(row);
    }
    return rows;
}

void planes(const std::vector<Method>& list, double sd) {
    constexpr int kSize = 18;
    constexpr int kWidth = 121;
    constexpr int kHeight = 3;
    fmt::print("\nPlane seen edge-on, {} orientations, {}^3, blur sd {}\n", kOrientations, kSize, sd);
    fmt::print("{:<24} {:>8} {:>8} {:>9} {:>9} {:>9}\n", "method", "rise", "max", "location", "max", "overshoot");
    const Volume block = sampled(kSize, [](const glm::dvec3&) { return 1.0; });
    std::vector<Edges> result(list.size());
    for (const Pose& pose : poses(kOrientations)) {
        const glm::dvec3 center = glm::dvec3((kSize - 1) / 2.0) + pose.shift;
        const Volume volume =
            sampled(kSize, [&](const glm::dvec3& x) { return step_up(glm::dot(pose.n, x - center), sd); });
        for (const double along : {-1.37, 1.71}) {
            const Camera camera = camera_at(center + along * pose.along, pose.across, pose.n, kHeight);
            const Image solid = reference::render(block, two_tone(0, 1), camera, with(EdgeEstimator::Off, 1), kWidth,
                                                  kHeight, Output::Tau);
            for (std::size_t m = 0; m < list.size(); ++m) {
                const PreparedVolume prepared(volume, two_tone(0, 1), list[m].settings);
                for (const auto& row : profiles(prepared.render(camera, kWidth, kHeight, Output::Tau), solid)) {
                    measure(row, (kWidth - 1) / 2.0, result[m]);
                }
            }
        }
    }
    for (std::size_t m = 0; m < list.size(); ++m) {
        fmt::print("{:<24} {:8.3f} {:8.3f} {:9.4f} {:9.4f} {:9.3f}\n", list[m].name, mean(result[m].rise),
                   largest(result[m].rise), mean(result[m].location), largest(result[m].location),
                   mean(result[m].overshoot));
    }
}

void walls(const std::vector<Method>& list) {
    constexpr int kSize = 24;
    constexpr int kPoses = 12;
    fmt::print("\nPlates, {} orientations, {}^3\n", kPoses, kSize);
    fmt::print("{:>4} {:>5} {:<16} {:>7} {:>7} {:>7} {:>8} {:>7} {:>7} {:>7} {:>8} {:>8} {:>8}\n", "sd", "thick",
               "method", "CoV", "min/mn", "max/mn", "tau/true", "rise", "locat.", "width", "voxels", "edge", "D2");
    for (const double sd : {0.5, 0.7}) {
        for (const double thickness : {0.6, 1.0, 1.5, 2.0, 3.0}) {
            for (const Method& method : list) {
                Edges edges;
                std::vector<double> cov, low, high, level, width;
                std::size_t voxels = 0, with_edge = 0, with_second = 0;
                for (const Pose& pose : poses(kPoses)) {
                    const glm::dvec3 center = glm::dvec3((kSize - 1) / 2.0) + pose.shift;
                    // Iso at half of what the plate's middle reaches, as one chooses it for thin structures.
                    const double peak = 1 - 2 * step_up(thickness / 2, sd);
                    const Volume volume = sampled(kSize, [&](const glm::dvec3& x) {
                        const double s = glm::dot(pose.n, x - center);
                        return step_up(s - thickness / 2, sd) - step_up(s + thickness / 2, sd);
                    });
                    Scene scene = two_tone(0, 1);
                    scene.iso_values = {std::min(0.5, 0.5 * peak)};
                    const PreparedVolume prepared(volume, scene, method.settings);
                    for (std::size_t i = 0; i < volume.values.size(); ++i) {
                        if (static_cast<double>(volume.values[i]) < scene.iso_values[0]) continue;
                        const glm::dvec3 x(prepared.field().voxel(i));
                        if (glm::length(x - center) > 9) continue;
                        ++voxels;
                        const auto& e = prepared.edges()[i];
                        with_edge += e.has_edge ? 1 : 0;
                        with_second += e.has_edge && std::isfinite(e.D2) ? 1 : 0;
                    }
                    // Face-on at 10 pixels per voxel: 8 x 8 voxels of the middle.
                    constexpr int kFace = 80;
                    Camera face = camera_at(center, pose.n, pose.across, kFace);
                    face.fov_y = glm::degrees(2 * std::atan(kFace / 10.0 / 2 / kEyeDistance));
                    const Image seen = prepared.render(face, kFace, kFace, Output::Tau);
                    double sum = 0, squares = 0, smallest = 1e9, biggest = 0;
                    for (const float t : seen.pixels) {
                        const double v = static_cast<double>(t);
                        sum += v;
                        squares += v * v;
                        smallest = std::min(smallest, v);
                        biggest = std::max(biggest, v);
                    }
                    const double n = static_cast<double>(seen.pixels.size());
                    const double average = sum / n;
                    cov.push_back(std::sqrt(std::max(squares / n - average * average, 0.0)) / average);
                    low.push_back(smallest / average);
                    high.push_back(biggest / average);
                    level.push_back(average / thickness);
                    // Edge-on: both faces, each from the middle outwards.
                    constexpr int kWidth = 241;
                    constexpr int kHeight = 5;
                    const Camera side = camera_at(center, pose.across, pose.n, kHeight);
                    const Image edge_on = prepared.render(side, kWidth, kHeight, Output::Tau);
                    for (int y = 0; y < kHeight; ++y) {
                        std::vector<double> right, left;
                        double top = 0;
                        for (int x = 0; x < kWidth; ++x)
                            top = std::max(top, static_cast<double>(edge_on.at(x, y, 0)));
                        for (int x = kWidth / 2; x < kWidth; ++x) {
                            right.push_back(static_cast<double>(edge_on.at(x, y, 0)) / top);
                            left.push_back(static_cast<double>(edge_on.at(kWidth - 1 - x, y, 0)) / top);
                        }
                        measure(right, thickness / 2 * kPixelsPerVoxel, edges);
                        measure(left, thickness / 2 * kPixelsPerVoxel, edges);
                        width.push_back((first_below(right, 0.5) + first_below(left, 0.5)) / kPixelsPerVoxel);
                    }
                }
                fmt::print("{:4} {:5} {:<16} {:7.3f} {:7.3f} {:7.3f} {:8.3f} {:7.3f} {:7.3f} {:7.3f} {:8} {:8} {:8}\n",
                           sd, thickness, method.name, mean(cov), *std::min_element(low.begin(), low.end()),
                           largest(high), mean(level), mean(edges.rise), mean(edges.location), mean(width), voxels,
                           with_edge, with_second);
            }
        }
    }
}

/// Largest |sum of h - 1| around a plane whose both sides are drawn, with estimated edges.
void unity(const std::vector<Method>& list, double sd) {
    constexpr int kSize = 22;
    fmt::print("\nPartition of unity next to a plane, estimated edges, blur sd {}\n", sd);
    fmt::print("{:<24} {:>9} {:>9} {:>9}\n", "method", "rms", "mean max", "max");
    for (const Method& method : list) {
        std::vector<double> worst;
        double squares = 0;
        double count = 0;
        const reference::Footprints footprints(method.settings);
        for (const Pose& pose : poses(kOrientations)) {
            const glm::dvec3 center = glm::dvec3((kSize - 1) / 2.0) + pose.shift;
            const Volume volume =
                sampled(kSize, [&](const glm::dvec3& x) { return step_up(glm::dot(pose.n, x - center), sd); });
            const PreparedVolume prepared(volume, two_tone(1, 1), method.settings);
            const auto field = prepared.field();
            std::mt19937 random(11);
            const auto uniform = [&] { return random() / 4294967296.0; };
            double most = 0;
            for (int i = 0; i < 400; ++i) {
                const glm::dvec3 x = center + (6 * uniform() - 3) * pose.n + (4 * uniform() - 2) * pose.across +
                                     (4 * uniform() - 2) * pose.along;
                double sum = 0;
                const glm::ivec3 low(glm::ceil(x - 3.0));
                const glm::ivec3 high(glm::floor(x + 3.0));
                for (int c = low.z; c <= high.z; ++c) {
                    for (int b = low.y; b <= high.y; ++b) {
                        for (int a = low.x; a <= high.x; ++a) {
                            const glm::ivec3 v(a, b, c);
                            sum += footprints.at_point(prepared.edges()[field.offset(v)], x - glm::dvec3(v));
                        }
                    }
                }
                most = std::max(most, std::abs(sum - 1));
                squares += (sum - 1) * (sum - 1);
                ++count;
            }
            worst.push_back(most);
        }
        fmt::print("{:<24} {:9.4f} {:9.4f} {:9.4f}\n", method.name, std::sqrt(squares / count), mean(worst),
                   largest(worst));
    }
}

/// Errors of D and n against the truth, voxels with an edge and |D| < R, away from the border.
void estimates(double sd) {
    constexpr int kSize = 22;
    fmt::print("\nEstimates, blur sd {}: error of D (voxel) and of n (degrees), and band voxels without an edge\n", sd);
    fmt::print("{:<20} {:<8} {:>8} {:>8} {:>8} {:>8} {:>9}\n", "method", "shape", "D rms", "max", "n rms", "max",
               "without");
    for (const auto e : {EdgeEstimator::Taylor, EdgeEstimator::Quadratic, EdgeEstimator::March, EdgeEstimator::Cubic}) {
        for (const double radius : {0.0, 10.0, 5.0, 3.0}) {
            double squares = 0, most = 0, angles = 0, widest = 0, count = 0, without = 0;
            for (const Pose& pose : poses(kOrientations)) {
                const glm::dvec3 center =
                    glm::dvec3((kSize - 1) / 2.0) + pose.shift - (radius > 6 ? 6.0 : 0.0) * pose.n;
                const auto distance = [&](const glm::dvec3& x) {
                    return radius > 0 ? glm::length(x - center) - radius : glm::dot(pose.n, x - center);
                };
                const Volume volume = sampled(kSize, [&](const glm::dvec3& x) { return step_up(distance(x), sd); });
                const PreparedVolume prepared(volume, two_tone(1, 1), with(e, 12));
                for (std::size_t i = 0; i < volume.values.size(); ++i) {
                    const glm::ivec3 v = prepared.field().voxel(i);
                    const glm::dvec3 x(v);
                    const double d = distance(x);
                    if (std::abs(d) >= kKernelRadius || glm::any(glm::lessThan(v, glm::ivec3(4))) ||
                        glm::any(glm::greaterThan(v, glm::ivec3(kSize - 5)))) {
                        continue;
                    }
                    ++count;
                    const auto& edge = prepared.edges()[i];
                    if (!edge.has_edge) {
                        ++without;
                        continue;
                    }
                    const glm::dvec3 outward = radius > 0 ? glm::normalize(x - center) : pose.n;
                    const double error = (edge.upper ? edge.D : -edge.D) - d;
                    const double angle = glm::degrees(
                        std::acos(std::clamp(glm::dot(edge.upper ? -edge.n : edge.n, outward), -1.0, 1.0)));
                    squares += error * error;
                    angles += angle * angle;
                    most = std::max(most, std::abs(error));
                    widest = std::max(widest, angle);
                }
            }
            const double n = count - without;
            fmt::print("{:<20} {:<8} {:8.4f} {:8.4f} {:8.3f} {:8.3f} {:8.2f}%\n", name_of(e),
                       radius > 0 ? fmt::format("r={}", radius) : "plane", std::sqrt(squares / n), most,
                       std::sqrt(angles / n), widest, 100 * without / count);
        }
    }
}

}  // namespace

int main(int argc, char** argv) {
    std::set<std::string> wanted(argv + 1, argv + argc);
    const auto runs = [&](const char* name) { return wanted.empty() || wanted.contains(name); };
    if (runs("estimates")) {
        estimates(0.7);
    }
    if (runs("planes")) planes(methods(), 0.7);
    if (runs("unity")) unity(methods(), 0.7);
    if (runs("walls")) {
        walls({{"off", with(EdgeEstimator::Off, 12)},
               {"march k=12", with(EdgeEstimator::March, 12)},
               {"march k=16", with(EdgeEstimator::March, 16)},
               {"march lerp", with(EdgeEstimator::March, 12, WarpFamily::Edge, FootprintMode::TableLerp)},
               {"cubic k=12", with(EdgeEstimator::Cubic, 12)}});
    }
    return 0;
}

#include "tests/properties/edge_quality.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "engine/reference/reference_renderer.h"
#include "engine/scene/ladder.h"
#include "engine/volume/analytic_volumes.h"

namespace edgesplat::test {
namespace {

constexpr int kOrientations = 24;
/// Pixels per voxel for steps of opacity: their position is accurate to half a pixel.
constexpr double kFine = 160;
constexpr int kFineWidth = 641;

Settings with(EdgeEstimator edges, FootprintMode mode, WarpFamily family = WarpFamily::Face) {
    Settings s;
    s.edges = edges;
    s.footprints = mode;
    s.warp = family;
    return s;
}

VolumePointer plane_volume(int size, const Pose& pose, const glm::dvec3& center) {
    return sampled(glm::ivec3(size), [&](const glm::dvec3& x) { return blurred_step(glm::dot(pose.n, x - center)); });
}

/// Pictures of a uniform block from every pose's camera, to divide the poses' pictures by. If faces cut kernels, the
/// grid's border is a face, too.
struct Strip {
    int size, width, height;  ///< voxels, pixels
    std::vector<Pose> list = poses(kOrientations);
    std::vector<Camera> cameras = {};
    std::vector<Image> soft = {}, cut = {};

    glm::dvec3 center(const Pose& pose) const { return glm::dvec3((size - 1) / 2.0) + pose.shift; }

    const Image& solid(const Settings& settings, std::size_t i) const {
        return (draws_faces(settings) ? cut : soft)[i];
    }

    /// Cameras across the plane's normal, which is screen +x.
    void place() {
        for (const Pose& pose : list)
            cameras.push_back(camera_at(center(pose), pose.across, pose.n, height));
    }
    void fill() {
        const auto block = sampled(glm::ivec3(size), [](const glm::dvec3&) { return 1.0; });
        for (const Camera& camera : cameras) {
            const auto of = [&](const Settings& settings) {
                return render_tau({block, two_tone(0, 1), camera, settings, width, height});
            };
            soft.push_back(of(with(EdgeEstimator::Off, FootprintMode::Isotropic)));
            cut.push_back(of(Settings{}));
        }
    }
};

/// Smallest signed distance to the scene's solid along the ray of a pixel, voxels. Index = world.
double closest(const AnalyticScene& solid, const Camera& camera, int x, int y, int width, int height) {
    const CameraFrame frame = camera_frame(camera);
    const double sx = (2 * (x + 0.5) / width - 1) * frame.tan_half_y * width / height;
    const double sy = (1 - 2 * (y + 0.5) / height) * frame.tan_half_y;
    const glm::dvec3 u = glm::normalize(frame.forward + sx * frame.right + sy * frame.up);
    const auto at = [&](double t) { return solid.signed_distance(frame.eye + t * u); };
    const double reach = 45;
    double best = kEyeDistance - reach;
    for (double t = best; t <= kEyeDistance + reach; t += 0.5)
        best = at(t) < at(best) ? t : best;
    double low = best - 0.5, high = best + 0.5;
    for (int i = 0; i < 50; ++i) {
        const double a = low + (high - low) / 3, b = high - (high - low) / 3;
        (at(a) < at(b) ? high : low) = at(a) < at(b) ? b : a;
    }
    return at((low + high) / 2);
}

/// Where the row leaves the solid, in pixels.
double true_silhouette(const AnalyticScene& solid, const Camera& camera, int y, int width, int height) {
    int low = 0, high = width - 1;  // inside, outside
    while (high - low > 1)
        (closest(solid, camera, (low + high) / 2, y, width, height) <= 0 ? low : high) = (low + high) / 2;
    const double a = closest(solid, camera, low, y, width, height);
    const double b = closest(solid, camera, high, y, width, height);
    return low + a / (a - b);
}

/// Adds the silhouette at `target`, seen along `direction`; `out` points out of the solid there, perpendicular to
/// `direction`.
void add_silhouette(const AnalyticScene& solid, const VolumePointer& volume, const glm::dvec3& target,
                    const glm::dvec3& direction, const glm::dvec3& out, const Settings& settings,
                    EdgeProfiles& profiles) {
    constexpr int kHeight = 6;
    const Camera camera = camera_at(target, direction, out, kHeight, kFine);
    const Image color = render({volume, two_tone(0, 4), camera, settings, kFineWidth, kHeight}).color;
    for (int y = 0; y < kHeight; ++y)
        add_profile(row_of(color, y, nullptr, 3), true_silhouette(solid, camera, y, kFineWidth, kHeight), profiles,
                    kFine);
}

double uniform(std::mt19937& random) {
    return random() / 4294967296.0;
}

/// Sums the weights of all voxels at x; `inside`: of the upper material only. `add_of(v, add)` calls add(edge, inside)
/// for both materials of voxel v.
struct Weights {
    double all = 0, inside = 0;
};
template <typename AddOf>
Weights weights_at(const reference::Footprints& footprints, const glm::dvec3& x, const AddOf& add_of) {
    Weights sum;
    const glm::ivec3 low(glm::ceil(x - 3.0)), high(glm::floor(x + 3.0));
    for (int c = low.z; c <= high.z; ++c) {
        for (int b = low.y; b <= high.y; ++b) {
            for (int a = low.x; a <= high.x; ++a) {
                const glm::ivec3 v(a, b, c);
                add_of(v, [&](const reference::VoxelEdge& edge, bool inside) {
                    if (edge.has_edge && edge.D <= -kKernelRadius) return;
                    const double h = footprints.at_point(edge, x - glm::dvec3(v));
                    sum.all += h;
                    if (inside) sum.inside += h;
                });
            }
        }
    }
    return sum;
}

/// Adds a voxel's estimate for its own material and the edges that it carries of the other.
template <typename Add>
void add_estimated(const reference::PreparedVolume& prepared, const glm::ivec3& v, const Add& add) {
    const reference::Field field = prepared.field();
    const std::size_t at = field.offset(v);
    add(prepared.edges()[at], prepared.scaled_scene().material(field.at(v)) == 1);
    for (const reference::CarriedEdge& carried : prepared.carried_by(at))
        add(carried.edge, carried.material == 1);
}

/// Collects deviations from 1, one list per orientation.
struct UnityCollector {
    double squares = 0, count = 0;
    std::vector<double> worst;

    void begin() { worst.push_back(0); }
    void add(double deviation) {
        squares += deviation * deviation;
        ++count;
        worst.back() = std::max(worst.back(), std::abs(deviation));
    }
    Unity result() const { return {std::sqrt(squares / count), mean(worst), largest_magnitude(worst)}; }
};

}  // namespace

std::vector<Method> compared_methods() {
    using E = EdgeEstimator;
    using F = FootprintMode;
    return {{"default (cubic, faces)", Settings{}},
            {"off", with(E::Off, F::Isotropic)},
            {"draft", preset_named("draft").settings},
            {"accurate", preset_named("accurate").settings},
            {"taylor", with(E::Taylor, F::Procedural)},
            {"march", with(E::March, F::Procedural)},
            {"paper's curve", with(E::March, F::Procedural, WarpFamily::Paper)},
            {"paper's own (taylor, warp2d)", paper_settings()}};
}

EdgeProfiles plane_edges(const Settings& settings, double cut_away) {
    constexpr int kSize = 18, kHeight = 12;
    Scene scene = two_tone(0, 1);
    for (int axis = 0; axis < 3 && cut_away > 0; ++axis) {
        glm::dvec3 outwards(0);
        outwards[axis] = 1;
        scene.effects.clip.keep.push_back({glm::dvec3(cut_away), -outwards});
        scene.effects.clip.keep.push_back({glm::dvec3(kSize - 1 - cut_away), outwards});
    }
    EdgeProfiles profiles;
    for (const Pose& pose : poses(kOrientations)) {
        const glm::dvec3 center = glm::dvec3((kSize - 1) / 2.0) + pose.shift;
        const Camera camera = camera_at(center, pose.across, pose.n, kHeight, kFine);
        const Image color =
            render({plane_volume(kSize, pose, center), scene, camera, settings, kFineWidth, kHeight}).color;
        for (int y = 0; y < kHeight; ++y)
            add_profile(row_of(color, y, nullptr, 3), (kFineWidth - 1) / 2.0, profiles, kFine);
    }
    return profiles;
}

EdgeProfiles sphere_silhouettes(const Settings& settings) {
    constexpr double kRadius = 9.3;
    const glm::dvec3 center(13.2, 13.6, 13.4);
    const AnalyticScene solid = sphere_scene(glm::ivec3(28), center, kRadius);
    const auto volume = std::make_shared<const Volume>(sample(solid));
    EdgeProfiles profiles;
    for (const Pose& pose : poses(16))
        add_silhouette(solid, volume, center + kRadius * pose.n, pose.across, pose.n, settings, profiles);
    return profiles;
}

EdgeProfiles torus_silhouettes(const Settings& settings) {
    constexpr double kMajor = 16, kMinor = 8;
    const glm::dvec3 center(27.2, 26.7, 11.4);
    const AnalyticScene solid = torus_scene({55, 55, 24}, center, kMajor, kMinor);
    const auto volume = std::make_shared<const Volume>(sample(solid));
    EdgeProfiles profiles;
    // The torus is a circle swept by a ball: its outermost point in direction n is the circle's plus a radius.
    for (const Pose& pose : poses(16)) {
        const glm::dvec3 ring = kMajor * glm::normalize(glm::dvec3(pose.n.x, pose.n.y, 0));
        add_silhouette(solid, volume, center + ring + kMinor * pose.n, pose.across, pose.n, settings, profiles);
    }
    for (int i = 0; i < 8; ++i) {
        const double phi = std::numbers::pi * (i / 4.0 + 0.07);
        const glm::dvec3 e(std::cos(phi), std::sin(phi), 0);
        const glm::dvec3 direction = glm::normalize(glm::dvec3(-0.2 * e.y, 0.2 * e.x, i % 2 == 0 ? 1 : -1));
        add_silhouette(solid, volume, center + (kMajor - kMinor) * e, direction, -e, settings, profiles);
    }
    return profiles;
}

Unity plane_unity(const Settings& settings, bool estimated) {
    constexpr int kSize = 22;
    const reference::Footprints footprints(settings, 0);
    UnityCollector collector;
    std::mt19937 random(11);
    for (const Pose& pose : poses(kOrientations)) {
        const glm::dvec3 center = glm::dvec3((kSize - 1) / 2.0) + pose.shift;
        const auto volume = plane_volume(kSize, pose, center);
        const reference::PreparedVolume prepared(*volume, two_tone(1, 1), settings, true);
        const auto known = [&](const glm::ivec3& v, const auto& add) {
            reference::VoxelEdge edge;
            edge.D = glm::dot(pose.n, center - glm::dvec3(v));
            edge.n = pose.n;
            edge.has_edge = edge.has_normal = true;
            edge.deepest = 0;
            reference::VoxelEdge other = edge;
            other.D = -edge.D;
            other.n = -edge.n;
            // The paper's kernels belong to their own side only.
            if (draws_faces(settings) || edge.D >= 0) add(edge, true);
            if (draws_faces(settings) || edge.D < 0) add(other, false);
        };
        const auto add_of = [&](const glm::ivec3& v, const auto& add) {
            return estimated ? add_estimated(prepared, v, add) : known(v, add);
        };
        collector.begin();
        for (int i = 0; i < 300; ++i) {
            const double across = 4 * uniform(random) - 2, along = 4 * uniform(random) - 2;
            const glm::dvec3 x =
                center + (6 * uniform(random) - 3) * pose.n + across * pose.across + along * pose.along;
            collector.add(weights_at(footprints, x, add_of).all - 1);
        }
    }
    return collector.result();
}

Unity picture_unity(const Settings& settings) {
    // A large grid minus a small one inside it: the incomplete warped kernels at the grid's border cancel.
    static const Strip small = [] {
        Strip s{.size = 18, .width = 121, .height = 5};
        s.place();
        s.fill();
        return s;
    }();
    static const Strip large = [] {
        Strip s{.size = small.size + 16, .width = small.width, .height = small.height};
        s.place();
        s.fill();
        return s;
    }();
    const auto tau_of = [&](const Strip& strip, std::size_t i) {
        return render_tau({plane_volume(strip.size, strip.list[i], strip.center(strip.list[i])), two_tone(1, 1),
                           strip.cameras[i], settings, strip.width, strip.height});
    };
    UnityCollector collector;
    for (std::size_t i = 0; i < small.list.size(); ++i) {
        const Image outer = tau_of(large, i), inner = tau_of(small, i);
        collector.begin();
        for (std::size_t p = 0; p < outer.pixels.size(); ++p) {
            const auto value = [&](const Image& image) { return static_cast<double>(image.pixels[p]); };
            collector.add((value(outer) - value(inner)) /
                              (value(large.solid(settings, i)) - value(small.solid(settings, i))) -
                          1);
        }
    }
    return collector.result();
}

SphereUnity sphere_unity(const Settings& settings, double radius) {
    constexpr int kSize = 22;
    const reference::Footprints footprints(settings, 0);
    UnityCollector collector;
    std::mt19937 random(11);
    double raw = 0, normalised = 0;
    for (const Pose& pose : poses(kOrientations)) {
        // A point of the surface is in the middle of the grid; the centre of a large sphere is near its side.
        const glm::dvec3 middle = glm::dvec3((kSize - 1) / 2.0) + pose.shift, center = middle - radius * pose.n;
        const auto volume = sampled(
            glm::ivec3(kSize), [&](const glm::dvec3& x) { return blurred_step(glm::length(x - center) - radius); });
        const reference::PreparedVolume prepared(*volume, two_tone(1, 1), settings, true);
        const auto add_of = [&](const glm::ivec3& v, const auto& add) { add_estimated(prepared, v, add); };
        collector.begin();
        for (int i = 0; i < 300; ++i) {
            const double across = 4 * uniform(random) - 2, along = 4 * uniform(random) - 2;
            const glm::dvec3 x =
                middle + (6 * uniform(random) - 3) * pose.n + across * pose.across + along * pose.along;
            const Weights sum = weights_at(footprints, x, add_of);
            const double truth = glm::length(x - center) <= radius ? 1 : 0;
            collector.add(sum.all - 1);
            raw += (sum.inside - truth) * (sum.inside - truth);
            const double share = sum.inside / sum.all;
            normalised += (share - truth) * (share - truth);
        }
    }
    return {collector.result(), std::sqrt(raw / collector.count), std::sqrt(normalised / collector.count)};
}

Wall wall(const Settings& settings, double thickness) {
    constexpr int kSize = 24, kFace = 80, kWidth = 241, kHeight = 6;
    constexpr double kBlur = 0.5;
    Scene scene = two_tone(0, 1);
    scene.iso_values = {std::min(0.5, 0.5 - blurred_step(thickness / 2, kBlur))};
    Wall result;
    EdgeProfiles profiles;
    result.low = 1;
    for (const Pose& pose : poses(12)) {
        const glm::dvec3 center = glm::dvec3((kSize - 1) / 2.0) + pose.shift;
        const auto volume = sampled(glm::ivec3(kSize), [&](const glm::dvec3& x) {
            const double s = glm::dot(pose.n, x - center);
            return blurred_step(s - thickness / 2, kBlur) - blurred_step(s + thickness / 2, kBlur);
        });
        const Image face =
            render_tau({volume, scene, camera_at(center, pose.n, pose.across, kFace, 10), settings, kFace, kFace});
        result.faces.push_back(evenness(face));
        result.low = std::min(result.low, result.faces.back().low);
        result.variation += result.faces.back().variation / 12;
        result.depth += result.faces.back().mean / thickness / 12;
        const Image side =
            render_tau({volume, scene, camera_at(center, pose.across, pose.n, kHeight), settings, kWidth, kHeight});
        for (int y = 0; y < kHeight; ++y) {
            std::vector<double> row = row_of(side, y);
            const double top = *std::max_element(row.begin(), row.end());
            for (double& v : row)
                v /= top;
            const auto middle = row.begin() + kWidth / 2;
            const std::vector<double> right(middle, row.end());
            std::vector<double> left(row.begin(), middle + 1);
            std::reverse(left.begin(), left.end());
            add_profile(right, thickness / 2 * kPixelsPerVoxel, profiles);
            add_profile(left, thickness / 2 * kPixelsPerVoxel, profiles);
        }
    }
    result.rise = mean(profiles.rise);
    result.location = mean_magnitude(profiles.location);
    result.missed = profiles.missed;
    return result;
}

double ball_matter(const Settings& settings, double radius) {
    constexpr int kSize = 20, kPixels = 80;
    const double scale = kPixels / (2.4 * radius);  // pixels per voxel
    double sum = 0;
    const std::vector<Pose> list = poses(8);
    for (const Pose& pose : list) {
        const glm::dvec3 center = glm::dvec3((kSize - 1) / 2.0) + pose.shift;
        const auto volume = sampled(
            glm::ivec3(kSize), [&](const glm::dvec3& x) { return blurred_step(glm::length(x - center) - radius); });
        const Image tau = render_tau({volume, two_tone(0, 1), camera_at(center, pose.n, pose.across, kPixels, scale),
                                      settings, kPixels, kPixels});
        for (const float value : tau.pixels)
            sum += static_cast<double>(value) / (scale * scale);
    }
    return sum / static_cast<double>(list.size()) / (4 * std::numbers::pi / 3 * std::pow(radius, 3));
}

}  // namespace edgesplat::test

#include "apps/paper/cube_measuring.h"

#include <cmath>
#include <numbers>

namespace edgesplat {
namespace {

constexpr double kSide = 12;   // of builtin:cube-hole, voxels
constexpr int kPixels = 640;   // 16 voxels
constexpr double kEye = 4000;  // voxels: the cube's far face is 0.3 % smaller than its near one

/// A frontal picture of optical depth, addressed in voxels from the cube's middle.
class Plan {
  public:
    explicit Plan(Image tau) : tau_(std::move(tau)) {}

    double at(double x, double y) const {
        const double px = x * test::kPixelsPerVoxel + (kPixels - 1) / 2.0;
        const double py = (kPixels - 1) / 2.0 - y * test::kPixelsPerVoxel;
        const int i = static_cast<int>(px), j = static_cast<int>(py);
        const double u = px - i, v = py - j;
        const auto pixel = [&](int a, int b) { return static_cast<double>(tau_.at(a, b, 0)); };
        return (pixel(i, j) * (1 - u) + pixel(i + 1, j) * u) * (1 - v) +
               (pixel(i, j + 1) * (1 - u) + pixel(i + 1, j + 1) * u) * v;
    }

  private:
    Image tau_;
};

/// The middle slices. At the cube's ends the filter bevels the edges, which is no blur of the method.
std::shared_ptr<const Volume> middle_slices(const Volume& volume) {
    constexpr int kSlices = 8;
    const glm::ivec3 dims = volume.geometry.dims;
    const auto slice = static_cast<std::ptrdiff_t>(dims.x) * dims.y;
    const auto begin = volume.values.begin() + (dims.z - kSlices) / 2 * slice;
    const auto middle = std::make_shared<Volume>();
    middle->geometry = volume.geometry;
    middle->geometry.dims.z = kSlices;
    middle->values.assign(begin, begin + kSlices * slice);
    finish_volume(*middle);
    return middle;
}

/// Radius of the circle with the same area as the values below one half around the middle of a slice, voxels.
double hole_radius(const Volume& volume) {
    const glm::ivec3 dims = volume.geometry.dims;
    constexpr double kStep = 0.02, kWithin = 5;
    double area = 0;
    for (double y = -kWithin; y < kWithin; y += kStep) {
        for (double x = -kWithin; x < kWithin; x += kStep) {
            const double px = (dims.x - 1) / 2.0 + x, py = (dims.y - 1) / 2.0 + y;
            const int i = static_cast<int>(px), j = static_cast<int>(py);
            const double u = px - i, v = py - j;
            const auto value = [&](int a, int b) { return static_cast<double>(volume.at(a, b, dims.z / 2)); };
            const double f = (value(i, j) * (1 - u) + value(i + 1, j) * u) * (1 - v) +
                             (value(i, j + 1) * (1 - u) + value(i + 1, j + 1) * u) * v;
            if (f < 0.5) area += kStep * kStep;
        }
    }
    return std::sqrt(area / std::numbers::pi);
}

}  // namespace

CubeQuality cube_quality(Renderer& renderer, const Volume& volume, const Settings& settings) {
    const auto slices = middle_slices(volume);
    renderer.set_volume(slices);
    const Scene scene = test::two_tone(0, 1);
    const glm::dvec3 middle = slices->geometry.center();
    Camera camera;
    camera.eye = middle + glm::dvec3(0, 0, kEye);
    camera.direction = {0, 0, -1};
    camera.up = {0, 1, 0};
    camera.fov_y = glm::degrees(2 * std::atan(kPixels / test::kPixelsPerVoxel / 2 / kEye));
    const Plan plan(*renderer.render(scene, camera, settings, kPixels, kPixels, {.tau = true}).tau);

    double solid = 0;  // optical depth of the solid: mean of four points near the corners, away from hole and sides
    for (int i = 0; i < 4; ++i)
        solid += plan.at(i % 2 == 0 ? 4 : -4, i < 2 ? 4 : -4) / 4;

    CubeQuality quality;
    quality.hole_radius = hole_radius(*slices);
    const double step = 1 / test::kPixelsPerVoxel;
    const auto add = [&](double from, double to, double expected, const auto& point, test::EdgeProfiles& profiles) {
        std::vector<double> profile;
        const double sign = to > from ? 1 : -1;
        for (double s = from; sign * (to - s) >= 0; s += sign * step) {
            const glm::dvec2 p = point(s);
            profile.push_back(plan.at(p.x, p.y) / solid);
        }
        test::add_profile(profile, std::abs(expected - from) / step, profiles);
    };
    for (int side = 0; side < 4; ++side) {
        const double angle = std::numbers::pi / 2 * side;
        const glm::dvec2 out(std::cos(angle), std::sin(angle)), along(-out.y, out.x);
        for (int i = -4; i <= 4; ++i)
            add(
                4, 7.8, kSide / 2, [&](double s) { return s * out + (i / 4.0) * along; }, quality.faces);
    }
    for (int i = 0; i < 64; ++i) {
        const double angle = 2 * std::numbers::pi * (i + 0.5) / 64;
        const glm::dvec2 out(std::cos(angle), std::sin(angle));
        add(
            4.75, 0.5, quality.hole_radius, [&](double s) { return s * out; }, quality.hole);
    }
    return quality;
}

}  // namespace edgesplat

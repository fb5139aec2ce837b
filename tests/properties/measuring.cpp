#include "tests/properties/measuring.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>

#include "engine/gpu/device_profile.h"

namespace edgesplat::test {
namespace {

/// The first point where a profile falls below `level`, in samples.
std::optional<double> first_below(std::span<const double> profile, double level) {
    for (std::size_t i = 1; i < profile.size(); ++i) {
        if (profile[i] < level && profile[i - 1] >= level)
            return static_cast<double>(i - 1) + (profile[i - 1] - level) / (profile[i - 1] - profile[i]);
    }
    return {};
}

/// The last such point before sample `end`: ripple inside the object is not the edge.
std::optional<double> last_below(std::span<const double> profile, double level, double end) {
    for (std::size_t i = std::min(profile.size(), static_cast<std::size_t>(std::ceil(end)) + 1); i-- > 1;) {
        if (profile[i] < level && profile[i - 1] >= level)
            return static_cast<double>(i - 1) + (profile[i - 1] - level) / (profile[i - 1] - profile[i]);
    }
    return {};
}

}  // namespace

bool shows_its_matter(const Image& color, const Image& tau) {
    double shown = 0, there = 0;
    for (std::size_t i = 0; i < tau.pixels.size(); ++i) {
        shown += static_cast<double>(color.pixels[4 * i + 3]);
        there -= std::expm1(-static_cast<double>(tau.pixels[i]));
    }
    // A plane through the eye keeps a slice of matter that only rounding makes.
    constexpr double kRounding = 1e-6;
    return shown >= 0.5 * there - kRounding * static_cast<double>(tau.pixels.size());
}

// Defined here, since the header would include Vulkan's headers in every test.
bool refines_pixels() {
    return gpu::profile_named(test_renderer().device().profile).refines;
}

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
        pose.shift.x = uniform() - 0.5;
        pose.shift.y = uniform() - 0.5;
        pose.shift.z = uniform() - 0.5;
        list.push_back(pose);
    }
    return list;
}

VolumePointer sampled(const glm::ivec3& dims, const std::function<double(const glm::dvec3&)>& value,
                      const glm::dmat3& axes) {
    const auto volume = std::make_shared<Volume>();
    volume->geometry.dims = dims;
    volume->geometry.index_to_world_axes = axes;
    for (int z = 0; z < dims.z; ++z) {
        for (int y = 0; y < dims.y; ++y) {
            for (int x = 0; x < dims.x; ++x)
                volume->values.push_back(static_cast<float>(value(glm::dvec3(x, y, z))));
        }
    }
    finish_volume(*volume);
    return volume;
}

double blurred_step(double s, double deviation) {
    return 0.5 * std::erfc(s / (deviation * std::numbers::sqrt2));
}

Scene two_tone(double below, double above) {
    Scene scene;
    scene.iso_values = {0.5};
    scene.materials = {{{1, 1, 1}, below}, {{1, 1, 1}, above}};
    scene.lights.clear();
    return scene;
}

Camera camera_at(const glm::dvec3& target, const glm::dvec3& direction, const glm::dvec3& right, int height,
                 double pixels_per_voxel) {
    Camera camera;
    camera.eye = target - kEyeDistance * direction;
    camera.direction = direction;
    camera.up = glm::cross(right, direction);
    camera.fov_y = glm::degrees(2 * std::atan(height / pixels_per_voxel / 2 / kEyeDistance));
    return camera;
}

void add_profile(std::span<const double> profile, double expected, EdgeProfiles& profiles, double pixels_per_voxel) {
    const auto low = first_below(profile, 0.1), half = first_below(profile, 0.5);
    const auto high = low ? last_below(profile, 0.9, *low) : std::nullopt;
    if (!low || !half || !high) {
        ++profiles.missed;
        return;
    }
    profiles.rise.push_back((*low - *high) / pixels_per_voxel);
    profiles.location.push_back((*half - expected) / pixels_per_voxel);
    profiles.overshoot.push_back(*std::max_element(profile.begin(), profile.end()) - 1);
}

double mean(std::span<const double> values) {
    double sum = 0;
    for (const double v : values)
        sum += v;
    return sum / static_cast<double>(values.size());
}

double mean_magnitude(std::span<const double> values) {
    double sum = 0;
    for (const double v : values)
        sum += std::abs(v);
    return sum / static_cast<double>(values.size());
}

double largest_magnitude(std::span<const double> values) {
    double most = 0;
    for (const double v : values)
        most = std::max(most, std::abs(v));
    return most;
}

Evenness evenness(const Image& image) {
    Evenness e;
    double squares = 0;
    e.low = e.high = static_cast<double>(image.pixels.front());
    for (const float pixel : image.pixels) {
        const double v = static_cast<double>(pixel);
        e.mean += v;
        squares += v * v;
        e.low = std::min(e.low, v);
        e.high = std::max(e.high, v);
    }
    const double n = static_cast<double>(image.pixels.size());
    e.mean /= n;
    e.variation = std::sqrt(std::max(squares / n - e.mean * e.mean, 0.0)) / e.mean;
    e.low /= e.mean;
    e.high /= e.mean;
    return e;
}

std::vector<double> row_of(const Image& image, int y, const Image* by, int channel) {
    std::vector<double> row;
    for (int x = 0; x < image.width; ++x) {
        const double divisor = by == nullptr ? 1.0 : static_cast<double>(by->at(x, y, 0));
        row.push_back(static_cast<double>(image.at(x, y, channel)) / divisor);
    }
    return row;
}

}  // namespace edgesplat::test

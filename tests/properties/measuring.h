// Tools to measure edges: orientations, volumes, cameras of known magnification, profiles and statistics.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "tests/properties/test_renderer.h"

namespace edgesplat::test {

inline constexpr double kPixelsPerVoxel = 40;
inline constexpr double kEyeDistance = 400;  ///< voxels: perspective deviates from a parallel ray by at most 0.1 voxel

/// Orientation and position of a plane in the grid; orthonormal. The list only depends on the count, on every machine.
struct Pose {
    glm::dvec3 n, across, along;
    glm::dvec3 shift;  ///< of its centre from the middle of the grid, within a voxel
};
std::vector<Pose> poses(int count);

/// Whether a picture is at least half as opaque, in the mean, as its optical depth says: finite and black is no picture
/// of matter.
bool shows_its_matter(const Image& color, const Image& tau);

/// Samples a function of index space into a finished volume.
VolumePointer sampled(const glm::ivec3& dims, const std::function<double(const glm::dvec3&)>& value,
                      const glm::dmat3& axes = glm::dmat3(1));

/// A step blurred by a Gaussian: 1 for s << 0, 1/2 at s = 0.
double blurred_step(double s, double deviation = 0.7);

/// A scene with extinctions below and above 0.5; white, unlit.
Scene two_tone(double below, double above);

/// Looks from kEyeDistance along `direction` (unit) at `target`; `right` (unit, perpendicular) is screen +x. Index =
/// world.
Camera camera_at(const glm::dvec3& target, const glm::dvec3& direction, const glm::dvec3& right, int height,
                 double pixels_per_voxel = kPixelsPerVoxel);

/// Measurements of one or more edges. Lengths in voxels.
struct EdgeProfiles {
    std::vector<double> rise;       ///< from 10 to 90 %
    std::vector<double> location;   ///< signed: positive if the edge lies further along the profile than expected
    std::vector<double> overshoot;  ///< beyond the inner level, relative to it
    int missed = 0;                 ///< profiles that never cross 10, 50 and 90 %
};

/// Adds a profile that falls from 1 to 0, one value per pixel, with its edge expected at sample `expected`.
void add_profile(std::span<const double> profile, double expected, EdgeProfiles& profiles,
                 double pixels_per_voxel = kPixelsPerVoxel);

double mean(std::span<const double> values);  ///< NaN if empty
double mean_magnitude(std::span<const double> values);
double largest_magnitude(std::span<const double> values);

/// Mean, coefficient of variation and extremes of a one-channel picture, relative to its mean.
struct Evenness {
    double mean = 0, variation = 0, low = 0, high = 0;
};
Evenness evenness(const Image& image);

/// One channel of a row, divided by the same row of `by` if given.
std::vector<double> row_of(const Image& image, int y, const Image* by = nullptr, int channel = 0);

}  // namespace edgesplat::test

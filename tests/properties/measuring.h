// What edges are measured with: orientations, volumes, cameras of known magnification, profiles and statistics.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "tests/properties/test_renderer.h"

namespace edgesplat::test {

inline constexpr double kPixelsPerVoxel = 40;
inline constexpr double kEyeDistance = 400;  ///< voxels: perspective bends a line of sight by 0.1 voxel at most

/// How a plane lies in the grid; orthonormal. The same for the same count on every machine.
struct Pose {
    glm::dvec3 n, across, along;
    glm::dvec3 shift;  ///< of its centre from the middle of the grid, within a voxel
};
std::vector<Pose> poses(int count);

/// Samples a function of index space; finished.
VolumePointer sampled(const glm::ivec3& dims, const std::function<double(const glm::dvec3&)>& value,
                      const glm::dmat3& axes = glm::dmat3(1));

/// A step blurred by a Gaussian: 1 where s << 0, half at s = 0.
double blurred_step(double s, double deviation = 0.7);

/// Extinctions below and above 0.5; white, unlit.
Scene two_tone(double below, double above);

/// Looks from kEyeDistance along `direction` (unit) at `target`; `right` (unit, across) is screen +x. Index = world.
Camera camera_at(const glm::dvec3& target, const glm::dvec3& direction, const glm::dvec3& right, int height,
                 double pixels_per_voxel = kPixelsPerVoxel);

/// What one edge, or many, came out as. Lengths in voxels.
struct EdgeProfiles {
    std::vector<double> rise;       ///< from 10 to 90 %
    std::vector<double> location;   ///< signed: positive where the edge lies further along the profile than expected
    std::vector<double> overshoot;  ///< beyond the inner level, in its unit
    int missed = 0;                 ///< profiles that never cross 10, 50 and 90 %
};

/// Adds a profile that falls from 1 to 0, one value a pixel, with its edge expected at sample `expected`.
void add_profile(std::span<const double> profile, double expected, EdgeProfiles& profiles,
                 double pixels_per_voxel = kPixelsPerVoxel);

double mean(std::span<const double> values);  ///< NaN of none
double mean_magnitude(std::span<const double> values);
double largest_magnitude(std::span<const double> values);

/// Mean, evenness and extremes of a picture of one channel, relative to its mean.
struct Evenness {
    double mean = 0, variation = 0, low = 0, high = 0;
};
Evenness evenness(const Image& image);

/// Channel 0 of a row, divided by the same row of `by` where given.
std::vector<double> row_of(const Image& image, int y, const Image* by = nullptr, int channel = 0);

}  // namespace edgesplat::test

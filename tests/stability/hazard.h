// Shared by the cases: difficult volumes, the device's estimates for them, and its pictures against the
// double-precision reference.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "engine/reference/1_estimate_edges.h"
#include "tests/properties/scenes.h"

namespace edgesplat::test {

inline constexpr EdgeEstimator kEstimators[] = {EdgeEstimator::Taylor, EdgeEstimator::March, EdgeEstimator::Cubic};

/// A volume with the function's values as float32, without further rounding.
VolumePointer volume_of(const glm::ivec3& dims, const std::function<float(const glm::ivec3&)>& value,
                        const glm::dmat3& axes = glm::dmat3(1));

/// A volume with the samples changed by a function.
VolumePointer changed(const VolumePointer& volume, const std::function<float(float, const glm::ivec3&)>& change);

/// White unlit matter of extinction 2 above the iso-value, completely visible from the front and slightly from the
/// side: 32 x 32.
Shot shot_of(VolumePointer volume, double iso_value = 0.5, double extinction = 2);

/// Pass 1 of a volume on the device and in double precision.
struct Estimate {
    glm::ivec3 dims{0};
    std::vector<reference::VoxelEdge> device, expected;
    std::vector<double> off_surface;  ///< distance or angle of the device's points to the surface: voxels or radians
    double lowest = 0, highest = 0;   ///< scaled samples

    const reference::VoxelEdge& at(const glm::ivec3& voxel) const;
    /// Number of edges without the volume's border.
    std::size_t edges() const;
    /// Share of the expected edges that the device lacks, or that differ by more than .002 voxels or radians. Other
    /// points of the same surface count as equal.
    double differing() const;
};
Estimate estimate(const VolumePointer& volume, const std::vector<double>& iso_values, EdgeEstimator estimator);

/// Renders with all outputs. Expects finite numbers, colours and opacity within 0..1, normals of length 1 or 0.
RenderResult sound(const Shot& shot, const std::string& what);

/// Difference of the device's picture to the reference's, after sound(): dB over all channels, and the largest.
ImageDifference against_reference(const Shot& shot, const std::string& what);

/// Expects edges like the reference's for every estimator, and the reference's picture.
void expect_as_reference(const Shot& shot, const std::string& what, double most_differing = 0.015, double psnr = 60);

/// Statistics of a channel over the middle of a picture: without a border of a quarter on each side.
struct Middle {
    double mean = 0, least = 0, most = 0;
};
Middle middle_of(const Image& image, int channel);

/// Optical depth along +x through a volume, per unit of extinction, with parallel rays over the middle of its y and z.
/// The result is the thickness of a body, voxels.
Middle thickness_along_x(Shot shot);

}  // namespace edgesplat::test

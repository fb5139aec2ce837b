// What the cases share: volumes that are trouble, what the device estimated of them, and its pictures against the
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

/// A volume of the function's values as float32, not rounded on the way.
VolumePointer volume_of(const glm::ivec3& dims, const std::function<float(const glm::ivec3&)>& value,
                        const glm::dmat3& axes = glm::dmat3(1));

/// The samples changed, and finished again.
VolumePointer changed(const VolumePointer& volume, const std::function<float(float, const glm::ivec3&)>& change);

/// White matter of extinction 2 above the iso-value, unlit, seen whole from in front and a little to the side: 32 x 32.
Shot shot_of(VolumePointer volume, double iso_value = 0.5, double extinction = 2);

/// Pass 1 of a volume on the device and in double precision.
struct Estimate {
    glm::ivec3 dims{0};
    std::vector<reference::VoxelEdge> device, expected;
    std::vector<double> off_surface;  ///< of the device's points of it, by double precision: voxels or radians
    double lowest = 0, highest = 0;   ///< scaled samples

    const reference::VoxelEdge& at(const glm::ivec3& voxel) const;
    /// Without the volume's border.
    std::size_t edges() const;
    /// Share of the expected edges that the device has otherwise: by more than .002 voxels or radians, or not at all;
    /// other points of the surface itself are as good.
    double differing() const;
};
Estimate estimate(const VolumePointer& volume, const std::vector<double>& iso_values, EdgeEstimator estimator);

/// With all outputs: every number finite, colours and opacity within 0..1, directions of length 1 or 0.
RenderResult sound(const Shot& shot, const std::string& what);

/// How far the device's picture is from the reference's, after sound(). dB over all channels, and the largest.
ImageDifference against_reference(const Shot& shot, const std::string& what);

/// Edges estimated as the reference does for every estimator, and the picture that the reference draws.
void expect_as_reference(const Shot& shot, const std::string& what, double most_differing = 0.015, double psnr = 60);

/// Mean of a channel over the middle of a picture: without a border of a quarter on each side.
struct Middle {
    double mean = 0, least = 0, most = 0;
};
Middle middle_of(const Image& image, int channel);

/// Optical depth along +x through a volume, per unit of extinction: parallel rays over the middle of its y and z. What
/// a body is thick, voxels.
Middle thickness_along_x(Shot shot);

}  // namespace edgesplat::test

// A scalar volume on the host: samples and geometry.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <vector>

namespace edgesplat {

class PackedVolume;

/// Positions of the voxels. Index space has its origin at the centre of voxel (0,0,0) and one unit per voxel. World
/// space is in mm (the file's own unit), in patient LPS if the file says so.
struct VolumeGeometry {
    glm::ivec3 dims{0};                 ///< voxels per axis, x fastest; each >= 1
    glm::dmat3 index_to_world_axes{1};  ///< columns: step of one voxel along i, j, k in mm (direction x spacing)
    glm::dvec3 origin{0};               ///< world position of voxel (0,0,0) in mm

    std::size_t voxel_count() const {
        return static_cast<std::size_t>(dims.x) * static_cast<std::size_t>(dims.y) * static_cast<std::size_t>(dims.z);
    }
    glm::dvec3 to_world(const glm::dvec3& index) const { return index_to_world_axes * index + origin; }
    glm::dvec3 to_index(const glm::dvec3& world) const { return glm::inverse(index_to_world_axes) * (world - origin); }
    glm::dvec3 spacing() const {
        return {glm::length(index_to_world_axes[0]), glm::length(index_to_world_axes[1]),
                glm::length(index_to_world_axes[2])};
    }
    double mean_spacing() const {
        const glm::dvec3 s = spacing();
        return (s.x + s.y + s.z) / 3;
    }
    /// World position of the centre of the volume.
    glm::dvec3 center() const { return to_world((glm::dvec3(dims) - 1.0) / 2.0); }
};

/// A scalar volume. Every sample is finite: non-finite samples are replaced by `min_value` and counted.
struct Volume {
    VolumeGeometry geometry;
    std::vector<float> values;  ///< (dims.z, dims.y, dims.x), x fastest, in the file's unit after slope/intercept
    bool in_patient = false;    ///< the world axes are the patient's: +x left, +y back, +z up
    float min_value = 0;        ///< smallest finite sample
    float max_value = 0;        ///< largest finite sample
    std::size_t non_finite_count = 0;   ///< samples that were NaN or infinite
    std::string name;                   ///< path, or "builtin:NAME"
    std::string stored_type;            ///< component type in the file, e.g. "int16"
    std::uint64_t checksum = 0;         ///< FNV-1a over dims, geometry and samples
    std::vector<std::string> notes;     ///< assumptions, choices and corrections made while reading, one sentence each
    std::vector<std::string> warnings;  ///< data omitted or invented while reading, one sentence each
    /// If set, `values` is empty and samples are read from this file on demand (packed_volume.h).
    std::shared_ptr<const PackedVolume> packed;

    float at(int x, int y, int z) const {
        return values[(static_cast<std::size_t>(z) * static_cast<std::size_t>(geometry.dims.y) +
                       static_cast<std::size_t>(y)) *
                          static_cast<std::size_t>(geometry.dims.x) +
                      static_cast<std::size_t>(x)];
    }
};

/// Completes a volume with given geometry and values: replaces non-finite samples by the smallest finite one (0 if
/// there is none), counts them, and sets min, max and checksum. Throws Error if dims and values disagree.
void finish_volume(Volume& volume);

}  // namespace edgesplat

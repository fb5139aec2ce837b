// A scalar volume on the host: samples and geometry.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <optional>
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

/// A label of a segmentation.
struct Label {
    std::uint64_t id = 0;             ///< the file's number; two's complement if the table is signed
    float value = 0;                  ///< the sample that stands for it in `Volume::values`
    std::string name;                 ///< empty: the file has none
    std::optional<glm::dvec3> color;  ///< linear light; not set: the file has none
};

/// The labels of a segmentation. A sample is the label's number if all numbers are below 2^24 in magnitude, which
/// floats represent exactly; otherwise it is the label's rank, from 0.
struct LabelTable {
    std::vector<Label> labels;  ///< ascending by `value`, which also ascends by number
    bool is_signed = false;     ///< whether ids are signed numbers

    /// The number as text, e.g. "312782546" or "-1".
    std::string number_of(const Label& label) const;
};

/// Labels by number: 1 + their place in a LabelTable; 0: none.
struct ShownLabels {
    std::vector<std::uint32_t> at;       ///< number per sample, in the order of `Volume::values`
    std::vector<std::uint32_t> largest;  ///< numbers that occur, most samples first
    bool on_scan = false;                ///< they colour the matter of a scan (segmentation.h), whose samples are drawn
};

/// A scalar volume. Every sample is finite: samples without data are replaced by `min_value`, counted and marked.
struct Volume {
    VolumeGeometry geometry;
    std::vector<float> values;  ///< (dims.z, dims.y, dims.x), x fastest, in the file's unit after slope/intercept
    bool in_patient = false;    ///< the world axes are the patient's: +x left, +y back, +z up
    float min_value = 0;        ///< smallest finite sample
    float max_value = 0;        ///< largest finite sample
    /// Standard deviation of the samples' noise, where most of them vary smoothly; 0 if none is noticed.
    double noise = 0;
    /// Whether all samples with data are the smallest or the largest one, as in a mask.
    bool two_values = false;
    std::size_t non_finite_count = 0;  ///< samples without data (`no_data`)
    /// Per sample whether it contains no data: NaN, infinite, or the fill value that the file or the user declares. Not
    /// set: none. Such samples are transparent and count in no statistics.
    std::shared_ptr<const std::vector<bool>> no_data;
    /// A value in the file's unit is `value_scale` times a sample: a power of two, 1 unless floats cannot hold the
    /// values. Scenes, `min_value`, and everything in the engine use the samples' unit.
    double value_scale = 1;
    std::shared_ptr<const LabelTable> labels;  ///< set by load_volume if the samples are labels (labels_of)
    /// Only of drawn_labels() and of a scan with a segmentation.
    std::shared_ptr<const ShownLabels> shown_labels;
    std::string geometry_source;     ///< the header's fields that define the geometry, e.g. "sform"; "none" if assumed
    std::string length_unit;         ///< the file's unit of length as its header names it; empty: none, mm are assumed
    std::string format;              ///< name of the format as its reader names it, e.g. "NRRD"; empty: none
    std::string name;                ///< path, or "builtin:NAME"
    std::string stored_type;         ///< component type in the file, e.g. "int16"
    std::uint64_t checksum = 0;      ///< FNV-1a over dims, geometry and samples
    std::vector<std::string> notes;  ///< assumptions, choices and corrections made while reading, one sentence each
    std::vector<std::string> warnings;  ///< data omitted or invented while reading, one sentence each
    /// If set, `values` is empty and samples are read from this file on demand (packed_volume.h).
    std::shared_ptr<const PackedVolume> packed;

    std::size_t index_of(int x, int y, int z) const {
        return (static_cast<std::size_t>(z) * static_cast<std::size_t>(geometry.dims.y) + static_cast<std::size_t>(y)) *
                   static_cast<std::size_t>(geometry.dims.x) +
               static_cast<std::size_t>(x);
    }
    float at(int x, int y, int z) const { return values[index_of(x, y, z)]; }
    bool has_data(std::size_t sample) const { return !no_data || !(*no_data)[sample]; }
    bool has_data(const glm::ivec3& i) const { return !no_data || !(*no_data)[index_of(i.x, i.y, i.z)]; }
    /// The sample, or NaN if it contains no data.
    float sample(std::size_t i) const { return has_data(i) ? values[i] : std::numeric_limits<float>::quiet_NaN(); }
    double in_file_unit(double value) const { return value * value_scale; }
    /// Of drawn_labels(): `values` is above 0.5 where a label is shown; its range counts as 0 to 1.
    bool is_label_mask() const { return shown_labels && !shown_labels->on_scan; }
    bool has_segmentation() const { return shown_labels && shown_labels->on_scan; }
};

/// An estimate of the standard deviation of the samples' noise, from a difference that is 0 where samples vary
/// smoothly: a lower quartile, so that edges do not count. 0 for fewer than 3 voxels along an axis.
double noise_of(const Volume& volume);

/// Completes a volume with given geometry and values: samples that are not finite, or already marked in `no_data`,
/// contain no data. They are replaced by the smallest of the others (0 if there is none), counted and marked. Sets min,
/// max, noise, two_values and checksum. Throws Error if dims and values disagree.
void finish_volume(Volume& volume);

}  // namespace edgesplat

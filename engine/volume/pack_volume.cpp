// Packs a volume. One or two passes over all samples find range and type, one writes the bricks of level 0, then each
// level is computed from the previous one. Every step has only one box of samples in memory.
#include "engine/volume/pack_volume.h"

#include <algorithm>
#include <cmath>
#include <system_error>

#include "engine/volume/checksum_internal.h"
#include "engine/volume/labels.h"
#include "engine/volume/pack_source_internal.h"
#include "engine/volume/packed_internal.h"
#include "footprints/temporary_file.h"

namespace edgesplat {
namespace {

namespace fs = std::filesystem;
using namespace detail;

constexpr int kBrick = PackedVolume::kBrick;
/// Maximum length of a box in samples: 16 MB for a box of bricks, 32 MB for the box that is averaged to the next level.
constexpr int kRow = 4096, kCoarseRow = 1024;
constexpr std::size_t kFirstBytes = 4096;
constexpr std::size_t kScanned = std::size_t{1} << 20;

std::size_t voxels_of(const glm::ivec3& size) {
    return static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) * static_cast<std::size_t>(size.z);
}

/// Conversion of samples to stored values and back.
struct Coding {
    SampleType type = SampleType::Float32;
    double slope = 1, intercept = 0, most = 0;  ///< most: largest stored value if quantised, else 0
    float stand_in = 0;                         ///< replaces non-finite samples

    bool quantised() const { return most > 0; }
    float stored(float value) const {
        if (!std::isfinite(value)) value = stand_in;
        if (!quantised()) return value;
        return static_cast<float>(std::clamp(std::round((static_cast<double>(value) - intercept) / slope), 0.0, most));
    }
    float value(float stored) const {
        return quantised() ? static_cast<float>(slope * static_cast<double>(stored) + intercept) : stored;
    }
};

struct Scan {
    float low = INFINITY, high = -INFINITY;
    bool integers = true;  ///< no fractions and no negative zeros
    std::size_t bad = 0;
    double sum = 0, error = 0;
    std::uint64_t checksum = 0;
    std::vector<std::uint64_t> label_voxels;  ///< samples with data of each label
};

class Progress {
  public:
    Progress(const PackOptions& options, const std::string& output) : options_(options), output_(output) {}
    void expect(std::size_t voxels) { all_ += static_cast<double>(voxels); }
    void add(std::size_t voxels, std::string_view what) {
        done_ += static_cast<double>(voxels);
        if (options_.progress && !options_.progress(std::min(1.0, done_ / all_), what))
            fail("{}: stopped; the file was not written", output_);
    }

  private:
    const PackOptions& options_;
    const std::string& output_;
    double done_ = 0, all_ = 0;
};

/// Scans all samples in the order of the checksum. With `coding`, uses the samples as read back from the packed file.
Scan scan(const PackSource& source, const Coding* coding, Progress& progress) {
    const VolumeGeometry& geometry = source.description.geometry;
    const glm::ivec3& dims = geometry.dims;
    const int rows = std::clamp(static_cast<int>(kScanned / static_cast<std::size_t>(dims.x)), 1, dims.y);
    std::vector<float> values;
    VolumeChecksum checksum(geometry);
    const LabelTable* const labels = source.description.labels.get();
    const bool ranks = labels != nullptr && has_ranks(*labels);
    Scan result;
    if (labels != nullptr) result.label_voxels.resize(labels->labels.size());
    for (int z = 0; z < dims.z; ++z)
        for (int y = 0; y < dims.y; y += rows) {
            const glm::ivec3 size(dims.x, std::min(rows, dims.y - y), 1);
            values.resize(voxels_of(size));
            source.read({0, y, z}, size, values);
            for (float& value : values) {
                if (coding != nullptr) {
                    const float kept = coding->value(coding->stored(value));
                    if (std::isfinite(value))
                        result.error = std::max(result.error, static_cast<double>(std::abs(kept - value)));
                    value = kept;
                }
                if (!std::isfinite(value)) {
                    ++result.bad;
                    continue;
                }
                if (labels != nullptr && coding == nullptr)
                    ++result.label_voxels[checked_place(*labels, value, source.description.name)];
                result.low = std::min(result.low, value);
                result.high = std::max(result.high, value);
                result.integers &= value == std::floor(value) && !(value == 0 && std::signbit(value));
                result.sum += static_cast<double>(value);
            }
            checksum.add(values, ranks ? labels : nullptr);
            progress.add(values.size(), "scanning all samples");
        }
    result.checksum = checksum.value();
    if (result.bad == geometry.voxel_count()) result.low = result.high = 0;
    return result;
}

Coding exact_coding(const Scan& scan) {
    const auto within = [&](float low, float high) { return scan.integers && scan.low >= low && scan.high <= high; };
    Coding coding{.stand_in = scan.low};
    if (within(0, 255))
        coding.type = SampleType::UInt8;
    else if (within(-32768, 32767))
        coding.type = SampleType::Int16;
    else if (within(0, 65535))
        coding.type = SampleType::UInt16;
    return coding;
}

Coding coding_for(const Scan& scan, int bits) {
    Coding coding = exact_coding(scan);
    if (bits == 0 || static_cast<int>(8 * size_of(coding.type)) <= bits) return coding;
    coding.type = bits == 8 ? SampleType::UInt8 : SampleType::UInt16;
    coding.most = bits == 8 ? 255 : 65535;
    coding.intercept = static_cast<double>(scan.low);
    const double range = static_cast<double>(scan.high) - coding.intercept;
    coding.slope = range > 0 ? range / coding.most : 1;
    return coding;
}

/// Writes the bricks of a level and keeps their ranges.
class LevelWriter {
  public:
    LevelWriter(Hdf5File& file, int level, const glm::ivec3& dims, const Coding& coding, bool compress)
        : file_(file),
          level_(level),
          bricks_(bricks_of(dims)),
          coding_(coding),
          samples_(file.create_dataset(level_path(level, "samples"),
                                       {coding.type, extent_of(dims), static_cast<std::uint64_t>(kBrick), compress})) {
        low_.assign(voxels_of(bricks_), INFINITY);
        high_.assign(voxels_of(bricks_), -INFINITY);
    }
    /// Writes stored values of a box that starts at a brick.
    void write(const glm::ivec3& low, const glm::ivec3& size, const std::vector<float>& stored) {
        samples_.write(extent_of(low), extent_of(size), SampleType::Float32, stored.data());
        std::size_t at = 0;
        for (int z = low.z; z < low.z + size.z; ++z)
            for (int y = low.y; y < low.y + size.y; ++y)
                for (int x = low.x; x < low.x + size.x; ++x) {
                    const float value = stored[at++];
                    const auto brick = brick_of(x, y, z);
                    low_[brick] = std::min(low_[brick], value);
                    high_[brick] = std::max(high_[brick], value);
                }
    }
    void finish() {
        samples_.finish();
        write_ranges("low", low_);
        write_ranges("high", high_);
    }
    const Hdf5Dataset& samples() const { return samples_; }

  private:
    std::size_t brick_of(int x, int y, int z) const {
        return (static_cast<std::size_t>(z / kBrick) * static_cast<std::size_t>(bricks_.y) +
                static_cast<std::size_t>(y / kBrick)) *
                   static_cast<std::size_t>(bricks_.x) +
               static_cast<std::size_t>(x / kBrick);
    }
    void write_ranges(const char* name, std::vector<float>& stored) {
        for (float& bound : stored)
            bound = coding_.value(bound);
        const Hdf5Extent extent = extent_of(bricks_);
        const Hdf5Dataset ranges =
            file_.create_dataset(level_path(level_, name), {.type = SampleType::Float32, .extent = extent});
        ranges.write({0, 0, 0}, extent, SampleType::Float32, stored.data());
        ranges.finish();
    }

    Hdf5File& file_;
    int level_;
    glm::ivec3 bricks_;
    const Coding& coding_;
    Hdf5Dataset samples_;
    std::vector<float> low_, high_;
};

/// Calls work(low, size) for boxes of one brick's height and depth that cover the volume.
template <typename Work>
void each_box(const glm::ivec3& dims, int row, const Work& work) {
    for (int z = 0; z < dims.z; z += kBrick)
        for (int y = 0; y < dims.y; y += kBrick)
            for (int x = 0; x < dims.x; x += row)
                work(glm::ivec3(x, y, z), glm::min(glm::ivec3(row, kBrick, kBrick), dims - glm::ivec3(x, y, z)));
}

/// Means over 2 x 2 x 2 samples of `fine` (fewer at its upper ends); `size` is that of the result.
std::vector<float> means(const std::vector<float>& fine, const glm::ivec3& fine_size, const glm::ivec3& size,
                         bool whole) {
    std::vector<float> result(voxels_of(size));
    const auto row = static_cast<std::size_t>(fine_size.x), slice = row * static_cast<std::size_t>(fine_size.y);
    std::size_t at = 0;
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                const glm::ivec3 first = 2 * glm::ivec3(x, y, z), last = glm::min(first + 2, fine_size);
                double sum = 0;
                for (int c = first.z; c < last.z; ++c)
                    for (int b = first.y; b < last.y; ++b)
                        for (int a = first.x; a < last.x; ++a)
                            sum += static_cast<double>(
                                fine[static_cast<std::size_t>(c) * slice + static_cast<std::size_t>(b) * row +
                                     static_cast<std::size_t>(a)]);
                const double mean = sum / static_cast<double>(voxels_of(last - first));
                result[at++] = static_cast<float>(whole ? std::floor(mean + 0.5) : mean);
            }
    return result;
}

/// Writes level 0 and the histogram.
void write_finest(Hdf5File& file, LevelWriter& writer, const PackSource& source, const Scan& scan, const Coding& coding,
                  Progress& progress) {
    const double low = static_cast<double>(scan.low), range = static_cast<double>(scan.high) - low;
    const double scale = range > 0 ? static_cast<double>(kPackedBins) / range : 0.0;
    std::vector<double> counts(kPackedBins, 0.0);
    std::vector<float> values;
    each_box(source.description.geometry.dims, kRow, [&](const glm::ivec3& first, const glm::ivec3& size) {
        values.resize(voxels_of(size));
        source.read(first, size, values);
        for (float& value : values) {
            value = coding.stored(value);
            ++counts[bin_of(coding.value(value), low, scale, kPackedBins)];
        }
        writer.write(first, size, values);
        progress.add(values.size(), "writing bricks");
    });
    const Hdf5Dataset histogram =
        file.create_dataset("/histogram", {.type = SampleType::UInt64, .extent = {kPackedBins}});
    histogram.write({0}, {kPackedBins}, SampleType::Float64, counts.data());
    histogram.finish();
}

void write_coarser(LevelWriter& writer, const Hdf5Dataset& finer, const glm::ivec3& fine_dims, const glm::ivec3& dims,
                   const Coding& coding, Progress& progress) {
    std::vector<float> fine;
    each_box(dims, kCoarseRow, [&](const glm::ivec3& first, const glm::ivec3& size) {
        const glm::ivec3 fine_size = glm::min(2 * size, fine_dims - 2 * first);
        fine.resize(voxels_of(fine_size));
        finer.read(extent_of(2 * first), extent_of(fine_size), SampleType::Float32, fine.data());
        writer.write(first, size, means(fine, fine_size, size, coding.type != SampleType::Float32));
        progress.add(voxels_of(size), "writing coarser levels");
    });
}

void write_description(Hdf5File& file, const Volume& volume, const Scan& scan, const Coding& coding,
                       const std::vector<std::uint64_t>& label_voxels) {
    const VolumeGeometry& geometry = volume.geometry;
    const glm::dvec3 dims(geometry.dims);
    file.set_text("format", kPackedFormat);
    file.set_whole_number("version", kPackedVersion);
    file.set_numbers("dims", SampleType::Int64, {3}, &dims.x);
    file.set_numbers("index_to_world_axes", SampleType::Float64, {3, 3}, &geometry.index_to_world_axes[0].x);
    file.set_numbers("origin", SampleType::Float64, {3}, &geometry.origin.x);
    file.set_number("in_patient", SampleType::UInt8, volume.in_patient ? 1 : 0);
    file.set_number("min", SampleType::Float32, static_cast<double>(volume.min_value));
    file.set_number("max", SampleType::Float32, static_cast<double>(volume.max_value));
    const auto missing = static_cast<double>(volume.non_finite_count);
    const double with_data = std::max(static_cast<double>(geometry.voxel_count()) - missing, 1.0);
    const double sum = scan.sum - missing * static_cast<double>(volume.min_value);
    file.set_number("mean", SampleType::Float64, sum / with_data);
    file.set_whole_number("non_finite_count", volume.non_finite_count);
    file.set_text("stored_type", volume.stored_type);
    file.set_whole_number("checksum", scan.checksum);
    file.set_text("source", volume.name);
    file.set_text("notes", fmt::format("{}", fmt::join(volume.notes, "\n")));
    file.set_text("warnings", fmt::format("{}", fmt::join(volume.warnings, "\n")));
    file.set_text("geometry_source", volume.geometry_source);
    file.set_text("length_unit", volume.length_unit);
    file.set_whole_number("labels", volume.labels ? volume.labels->labels.size() : 0);
    file.set_number("labels_signed", SampleType::UInt8, volume.labels && volume.labels->is_signed ? 1 : 0);
    if (volume.labels) write_labels(file, *volume.labels, label_voxels);
    file.set_number("slope", SampleType::Float64, coding.slope);
    file.set_number("intercept", SampleType::Float64, coding.intercept);
    file.set_number("quantisation_error", SampleType::Float64, scan.error);
}

void check_dims(const Volume& volume) {
    const glm::ivec3& dims = volume.geometry.dims;
    for (int axis = 0; axis < 3; ++axis)
        if (dims[axis] < 1 || static_cast<std::size_t>(dims[axis]) > kMaxPackedVoxelsPerAxis)
            fail("{}: dims {} x {} x {}: each must be from 1 to {}", volume.name, dims.x, dims.y, dims.z,
                 kMaxPackedVoxelsPerAxis);
    if (volume.geometry.voxel_count() > kMaxPackedVoxels)
        fail("{}: dims {} x {} x {}: more than 2^40 voxels", volume.name, dims.x, dims.y, dims.z);
    check_axes(volume);
}

/// Checks the free disk space. The deflated size is unknown beforehand, so compressed files are not checked.
void check_space(const std::string& output, const std::vector<VolumeGeometry>& levels, const Coding& coding) {
    double bytes = 1e6;
    for (const VolumeGeometry& level : levels)
        bytes += static_cast<double>(voxels_of(bricks_of(level.dims))) *
                 (kBrick * kBrick * kBrick * static_cast<double>(size_of(coding.type)) + 64);
    const auto folder = fs::path(output).parent_path();
    std::error_code error;
    const auto space = fs::space(folder.empty() ? "." : folder, error);
    if (error) fail("{}: cannot be written: {}", output, error.message());
    if (static_cast<double>(space.available) < bytes)
        fail("{}: needs {:.0f} MB on disk or more, {:.0f} MB are free; --compress or --quantise make it smaller",
             output, bytes / 1e6, static_cast<double>(space.available) / 1e6);
}

/// Calls `step`, which writes `output`, and converts its errors.
template <typename Step>
auto writing(const std::string& output, const Step& step) {
    try {
        return step();
    } catch (const std::system_error& error) {
        fail("{}: cannot be written: {}", output, error.code().message());
    }
}

PackSummary pack(const PackSource& source, const std::string& output, const PackOptions& options) {
    if (options.quantise != 0 && options.quantise != 8 && options.quantise != 16)
        fail("quantise: {} bits, expected 8 or 16", options.quantise);
    Volume volume = source.description;
    check_dims(volume);
    const double largest = std::max(std::abs(volume.in_file_unit(static_cast<double>(volume.min_value))),
                                    std::abs(volume.in_file_unit(static_cast<double>(volume.max_value))));
    if (volume.value_scale != 1 && !(largest < 1e38 && largest > 1e-30))
        fail("{}: its values reach {:.3g}, which a packed volume cannot store; expected 1e-30 to 1e38", volume.name,
             largest);
    const auto levels = level_geometries(volume.geometry);
    Progress progress(options, output);
    const std::size_t voxels = volume.geometry.voxel_count();
    progress.expect(2 * voxels + (levels.size() > 1 ? voxels / 7 : 0));
    // Fails before the long scan if there is no space even for one byte per sample.
    if (!options.compress) check_space(output, levels, {.type = SampleType::UInt8});
    Scan found = scan(source, nullptr, progress);
    const std::vector<std::uint64_t> label_voxels = std::move(found.label_voxels);
    const Coding coding = coding_for(found, options.quantise);
    if (volume.labels && coding.quantised()) {
        volume.labels.reset();
        volume.warnings.push_back("Its labels were left out when it was packed: quantised numbers are no labels.");
    }
    if (!options.compress) check_space(output, levels, coding);
    volume.non_finite_count = found.bad;
    if (coding.quantised() || found.bad > 0) {
        progress.expect(voxels);
        found = scan(source, &coding, progress);
    }
    volume.min_value = found.low;
    volume.max_value = found.high;
    if (source.streamed()) add_value_notes(volume);
    if (volume.non_finite_count > 0)
        volume.notes.push_back(fmt::format("{} samples without data became {}, as packed volumes do not mark them.",
                                           volume.non_finite_count, volume.min_value));
    if (coding.quantised())
        volume.notes.push_back(
            fmt::format("Quantised to {} bits when it was packed: samples are off by at most {:.3g}.", options.quantise,
                        found.error));

    TemporaryFile temporary = writing(output, [&] {
        TemporaryFile made(output);
        made.write(std::string(kFirstBytes, '\0'));  // HDF5 cannot close a file whose first bytes it cannot write
        made.sync();
        return made;
    });
    auto file = Hdf5File::create(temporary.path().string(), output);
    {
        std::optional<LevelWriter> finer, writer;
        try {
            for (std::size_t i = 0; i < levels.size(); ++i) {
                writer.emplace(file, static_cast<int>(i), levels[i].dims, coding, options.compress);
                if (i == 0)
                    write_finest(file, *writer, source, found, coding, progress);
                else
                    write_coarser(*writer, finer->samples(), levels[i - 1].dims, levels[i].dims, coding, progress);
                writer->finish();
                finer.emplace(std::move(*writer));
            }
            write_description(file, volume, found, coding, label_voxels);
        } catch (...) {
            file.abandon();
            throw;
        }
    }
    file.close();
    const std::uint64_t bytes = fs::file_size(temporary.path());
    writing(output, [&] {
        temporary.sync();
        temporary.rename_to_target();
    });
    return {volume.geometry,  static_cast<int>(levels.size()), std::string(name_of(coding.type)), found.error, bytes,
            source.streamed()};
}

}  // namespace

PackSummary pack_volume(const Volume& volume, const std::string& output, const PackOptions& options) {
    require_samples(volume, "packing");
    return pack(*memory_source(volume), output, options);
}

PackSummary pack_file(const std::string& path, const LoadOptions& load, const std::string& output,
                      const PackOptions& options) {
    return pack(*open_source(path, load), output, options);
}

}  // namespace edgesplat

#include "engine/volume/packed_volume.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <sstream>

#include "engine/volume/checksum_internal.h"
#include "engine/volume/load_volume.h"
#include "engine/volume/packed_internal.h"

namespace edgesplat {

using namespace detail;

struct PackedVolume::State {
    struct Level {
        VolumeGeometry geometry;
        Hdf5Dataset samples;
        glm::ivec3 bricks{0};
        std::vector<Range> ranges;  ///< of each brick, x fastest
    };
    Hdf5File file;
    std::vector<Level> levels;
    Volume description;
    std::string path, sample_type, source;
    double slope = 1, intercept = 0, mean = 0, quantisation_error = 0;
    Histogram histogram;
    std::vector<std::uint64_t> label_voxels;
};

namespace {

/// Chunk cache per level. A box slightly larger than a brick touches 27 bricks, and the next box touches most of them
/// again.
constexpr std::size_t kCache = std::size_t{1} << 26;

double finite(const Hdf5File& file, const std::string& path, const std::string& name) {
    const double value = file.number(name);
    if (!std::isfinite(value)) fail("{}: attribute {}: {} is not finite", path, name, value);
    return value;
}

void check_format(const Hdf5File& file, const std::string& path) {
    const std::string format = file.text("format");
    if (format != kPackedFormat) fail("{}: attribute format: '{}', expected '{}'", path, format, kPackedFormat);
    const auto version = file.whole_number("version");
    if (version < 1 || version > kPackedVersion)
        fail("{}: attribute version: {}, expected 1 to {}: it was packed by another version of this program", path,
             version, kPackedVersion);
}

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);)
        lines.push_back(line);
    return lines;
}

VolumeGeometry read_geometry(const Hdf5File& file, const std::string& path) {
    VolumeGeometry geometry;
    const auto dims = file.numbers("dims", 3), axes = file.numbers("index_to_world_axes", 9),
               origin = file.numbers("origin", 3);
    double voxels = 1;
    for (int axis = 0; axis < 3; ++axis) {
        const auto i = static_cast<std::size_t>(axis);
        voxels *= dims[i];
        if (!(dims[i] >= 1) || !(dims[i] <= static_cast<double>(kMaxPackedVoxelsPerAxis)) ||
            dims[i] != std::floor(dims[i]))
            fail("{}: attribute dims: {}, expected whole numbers from 1 to {}", path, dims[i], kMaxPackedVoxelsPerAxis);
        geometry.dims[axis] = static_cast<int>(dims[i]);
        geometry.origin[axis] = origin[i];
        geometry.index_to_world_axes[axis] = {axes[3 * i], axes[3 * i + 1], axes[3 * i + 2]};
    }
    if (voxels > static_cast<double>(kMaxPackedVoxels)) fail("{}: attribute dims: more than 2^40 voxels", path);
    return geometry;
}

/// The volume's description without samples.
Volume read_description(const Hdf5File& file, const std::string& path) {
    Volume volume;
    volume.name = path;
    volume.geometry = read_geometry(file, path);
    check_axes(volume);
    volume.in_patient = file.whole_number("in_patient") != 0;
    volume.min_value = static_cast<float>(finite(file, path, "min"));
    volume.max_value = static_cast<float>(finite(file, path, "max"));
    if (!(volume.min_value <= volume.max_value))
        fail("{}: attribute min: {} is above max, {}", path, volume.min_value, volume.max_value);
    volume.non_finite_count = file.whole_number("non_finite_count");
    volume.stored_type = file.text("stored_type");
    volume.checksum = file.whole_number("checksum");
    volume.notes = lines_of(file.text("notes"));
    if (file.whole_number("version") == 1) return volume;
    volume.warnings = lines_of(file.text("warnings"));
    volume.geometry_source = file.text("geometry_source");
    volume.length_unit = file.text("length_unit");
    return volume;
}

Histogram read_histogram(const Hdf5File& file, const std::string& path, const Volume& volume) {
    const auto dataset = file.dataset("/histogram");
    check_extent(path, "/histogram", dataset.extent(), {kPackedBins});
    std::vector<std::uint64_t> counts(kPackedBins);
    dataset.read({0}, {kPackedBins}, SampleType::UInt64, counts.data());
    const auto total = std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
    if (total != volume.geometry.voxel_count())
        fail("{}: /histogram: counts {} samples, expected {}", path, total, volume.geometry.voxel_count());
    // Samples without data are stored as the smallest value.
    counts.front() -= std::min<std::uint64_t>(counts.front(), volume.non_finite_count);
    return {
        static_cast<double>(volume.min_value), static_cast<double>(volume.max_value), {counts.begin(), counts.end()}};
}

std::vector<PackedVolume::Range> read_ranges(const Hdf5File& file, const std::string& path, int level,
                                             const glm::ivec3& bricks) {
    const Hdf5Extent extent = extent_of(bricks);
    const auto dataset_of = [&](bool low) {
        const std::string name = level_path(level, low ? "low" : "high");
        auto dataset = file.dataset(name);
        check_extent(path, name, dataset.extent(), extent);
        return dataset;
    };
    const std::array<Hdf5Dataset, 2> datasets{dataset_of(false), dataset_of(true)};
    const std::size_t count = extent[0] * extent[1] * extent[2];
    check_memory(path, fmt::format("level {} with {} bricks", level, count), 3 * count * sizeof(float));
    std::vector<PackedVolume::Range> ranges(count);
    std::vector<float> bounds(ranges.size());
    for (const bool low : {true, false}) {
        const Hdf5Dataset& dataset = datasets[low ? 1 : 0];
        dataset.read({0, 0, 0}, extent, SampleType::Float32, bounds.data());
        for (std::size_t i = 0; i < ranges.size(); ++i)
            (low ? ranges[i].low : ranges[i].high) = bounds[i];
    }
    for (const auto& range : ranges)
        if (!(range.low <= range.high))
            fail("{}: {}: {} is above the brick's high, {}", path, level_path(level, "low"), range.low, range.high);
    return ranges;
}

void check_box(const PackedVolume& volume, int level, const glm::ivec3& low, const glm::ivec3& size) {
    if (level < 0 || level >= volume.levels())
        fail("{}: level {}: it has {} levels", volume.path(), level, volume.levels());
    const glm::ivec3& dims = volume.geometry(level).dims;
    for (int axis = 0; axis < 3; ++axis)
        if (low[axis] < 0 || size[axis] < 1 || low[axis] > dims[axis] - size[axis])
            fail("{}: level {}: box of {},{},{} voxels at {},{},{} is not within {} x {} x {}", volume.path(), level,
                 size.x, size.y, size.z, low.x, low.y, low.z, dims.x, dims.y, dims.z);
}

}  // namespace

PackedVolume::PackedVolume(std::unique_ptr<State> state) : state_(std::move(state)) {}
PackedVolume::~PackedVolume() = default;

std::shared_ptr<const PackedVolume> PackedVolume::open(const std::string& path) {
    auto state = std::make_unique<State>();
    state->path = path;
    state->file = Hdf5File::open(path);
    const Hdf5File& file = state->file;
    check_format(file, path);
    state->description = read_description(file, path);
    state->source = file.text("source");
    state->slope = finite(file, path, "slope");
    state->intercept = finite(file, path, "intercept");
    state->mean = finite(file, path, "mean");
    state->quantisation_error = finite(file, path, "quantisation_error");
    state->histogram = read_histogram(file, path, state->description);
    if (file.whole_number("version") > 1) {
        const std::uint64_t voxels = state->description.geometry.voxel_count();
        auto [table, counts] = read_labels(file, path, file.whole_number("labels"),
                                           voxels - std::min(voxels, state->description.non_finite_count));
        state->description.labels = std::move(table);
        state->label_voxels = std::move(counts);
    }
    for (const VolumeGeometry& geometry : level_geometries(state->description.geometry)) {
        const int level = static_cast<int>(state->levels.size());
        const std::string name = level_path(level, "samples");
        State::Level next{geometry, file.dataset(name, kCache), bricks_of(geometry.dims), {}};
        check_extent(path, name, next.samples.extent(), extent_of(geometry.dims));
        const std::string type(name_of(next.samples.type()));
        if (level == 0) state->sample_type = type;
        if (type != state->sample_type)
            fail("{}: {}: type {}, but level 0 has {}", path, name, type, state->sample_type);
        next.ranges = read_ranges(file, path, level, next.bricks);
        state->levels.push_back(std::move(next));
    }
    return std::shared_ptr<const PackedVolume>(new PackedVolume(std::move(state)));
}

int PackedVolume::levels() const {
    return static_cast<int>(state_->levels.size());
}
const VolumeGeometry& PackedVolume::geometry(int level) const {
    if (level < 0 || level >= levels()) fail("{}: level {}: it has {} levels", state_->path, level, levels());
    return state_->levels[static_cast<std::size_t>(level)].geometry;
}
const std::string& PackedVolume::path() const {
    return state_->path;
}
const std::string& PackedVolume::sample_type() const {
    return state_->sample_type;
}
const std::string& PackedVolume::source() const {
    return state_->source;
}
double PackedVolume::mean() const {
    return state_->mean;
}
double PackedVolume::quantisation_error() const {
    return state_->quantisation_error;
}
const Histogram& PackedVolume::histogram() const {
    return state_->histogram;
}
const std::vector<std::uint64_t>& PackedVolume::label_voxels() const {
    return state_->label_voxels;
}
const Volume& PackedVolume::description() const {
    return state_->description;
}

PackedVolume::Range PackedVolume::range(int level, const glm::ivec3& low, const glm::ivec3& size) const {
    check_box(*this, level, low, size);
    const auto& bricks = state_->levels[static_cast<std::size_t>(level)];
    const glm::ivec3 first = low / kBrick, last = (low + size - 1) / kBrick;
    Range result{INFINITY, -INFINITY};
    for (int z = first.z; z <= last.z; ++z)
        for (int y = first.y; y <= last.y; ++y) {
            const auto row = (static_cast<std::size_t>(z) * static_cast<std::size_t>(bricks.bricks.y) +
                              static_cast<std::size_t>(y)) *
                             static_cast<std::size_t>(bricks.bricks.x);
            for (int x = first.x; x <= last.x; ++x) {
                const Range& brick = bricks.ranges[row + static_cast<std::size_t>(x)];
                result = {std::min(result.low, brick.low), std::max(result.high, brick.high)};
            }
        }
    return result;
}

void PackedVolume::read(int level, const glm::ivec3& low, const glm::ivec3& size, std::span<float> out) const {
    check_box(*this, level, low, size);
    const auto extent = extent_of(size);
    if (out.size() != extent[0] * extent[1] * extent[2])
        fail("{}: buffer for {} samples, box of {}", state_->path, out.size(), fmt::join(extent, " x "));
    state_->levels[static_cast<std::size_t>(level)].samples.read(extent_of(low), extent, SampleType::Float32,
                                                                 out.data());
    if (state_->slope == 1 && state_->intercept == 0) return;
    for (float& value : out)
        value = static_cast<float>(state_->slope * static_cast<double>(value) + state_->intercept);
}

Volume open_packed(const std::string& path) {
    const auto packed = PackedVolume::open(path);
    Volume volume = packed->description();
    volume.packed = packed;
    return volume;
}

Volume load_level(const Volume& volume, int level) {
    if (!volume.packed) fail("{}: has no levels: it is not a packed volume", volume.name);
    const PackedVolume& packed = *volume.packed;
    Volume result;
    result.geometry = packed.geometry(level);
    const glm::ivec3& dims = result.geometry.dims;
    const std::size_t voxels = result.geometry.voxel_count();
    if (voxels > kMaxVoxels)
        fail(
            "{}: level {}: {} x {} x {} voxels are too many for memory, expected at most 2^31; --iso draws "
            "the numbers of labels from the file",
            volume.name, level, dims.x, dims.y, dims.z);
    check_memory(volume.name, fmt::format("level {} with {} x {} x {} voxels", level, dims.x, dims.y, dims.z),
                 voxels * sizeof(float));
    result.in_patient = volume.in_patient;
    result.name = volume.name;
    result.stored_type = volume.stored_type;
    result.notes = volume.notes;
    result.warnings = volume.warnings;
    result.geometry_source = volume.geometry_source;
    result.length_unit = volume.length_unit;
    result.format = volume.format;
    result.values.resize(voxels);
    packed.read(level, glm::ivec3(0), dims, result.values);
    // Means of labels are no labels.
    if (level == 0 && volume.labels) {
        for (const float sample : result.values)
            (void)checked_place(*volume.labels, sample, volume.name);
        result.labels = volume.labels;
    }
    finish_volume(result);
    return result;
}

Volume small_labels_in_memory(Volume volume) {
    const bool small = volume.geometry.voxel_count() <= kMaxVoxelsAnalysed;
    if (volume.packed && volume.labels && small) return load_level(volume, 0);
    return volume;
}

int finest_level_within(const PackedVolume& packed, std::size_t voxels) {
    int level = 0;
    while (level + 1 < packed.levels() && packed.geometry(level).voxel_count() > voxels)
        ++level;
    return level;
}

float value_at(const Volume& volume, const glm::ivec3& voxel) {
    if (!volume.packed) return volume.at(voxel.x, voxel.y, voxel.z);
    float value = 0;
    volume.packed->read(0, voxel, glm::ivec3(1), {&value, 1});
    return value;
}

void require_samples(const Volume& volume, std::string_view what) {
    if (volume.packed)
        fail("{}: {} needs all samples in memory; packed volumes are drawn by splatting only", volume.name, what);
}

}  // namespace edgesplat

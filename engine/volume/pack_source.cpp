#include "engine/volume/pack_source_internal.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>

#include "engine/volume/analytic_volumes.h"
#include "engine/volume/io/samples.h"
#include "engine/volume/labels.h"
#include "engine/volume/load_volume.h"
#include "engine/volume/parallel.h"

namespace edgesplat::detail {
namespace {

constexpr float kLargestExact = 16777216;  // floats represent all whole numbers up to it

class AnalyticSource final : public PackSource {
  public:
    explicit AnalyticSource(const std::string& path) : scene_(builtin_scene(path)) {
        description.name = "builtin:" + scene_.name;
        description.stored_type = "float64";
        description.geometry.dims = scene_.dims;
        for (int axis = 0; axis < 3; ++axis)
            description.geometry.index_to_world_axes[axis][axis] = scene_.spacing[axis];
    }
    void read(const glm::ivec3& low, const glm::ivec3& size, std::span<float> out) const override {
        parallel_for(size.y * size.z, [&](int first, int last) {
            for (int row = first; row < last; ++row) {
                float* const to = out.data() + static_cast<std::size_t>(row) * static_cast<std::size_t>(size.x);
                for (int x = 0; x < size.x; ++x)
                    to[x] = sample_at(scene_, low + glm::ivec3(x, row % size.y, row / size.y));
            }
        });
    }

  private:
    AnalyticScene scene_;
};

class MemorySource final : public PackSource {
  public:
    explicit MemorySource(const Volume& volume) : volume_(&volume) { describe(); }
    explicit MemorySource(Volume&& volume) : owned_(std::move(volume)), volume_(&owned_) { describe(); }
    bool streamed() const override { return false; }
    void read(const glm::ivec3& low, const glm::ivec3& size, std::span<float> out) const override {
        float* to = out.data();
        for (int z = low.z; z < low.z + size.z; ++z)
            for (int y = low.y; y < low.y + size.y; ++y)
                for (int x = 0; x < size.x; ++x)
                    *to++ = static_cast<float>(volume_->in_file_unit(
                        static_cast<double>(volume_->sample(volume_->index_of(low.x + x, y, z)))));
    }

  private:
    void describe() {
        description.geometry = volume_->geometry;
        description.in_patient = volume_->in_patient;
        description.name = volume_->name;
        description.stored_type = volume_->stored_type;
        description.notes = volume_->notes;
        description.min_value = volume_->min_value;
        description.max_value = volume_->max_value;
        description.value_scale = volume_->value_scale;
        description.labels = volume_->labels;
        description.warnings = volume_->warnings;
        description.geometry_source = volume_->geometry_source;
        description.length_unit = volume_->length_unit;
    }
    Volume owned_;
    const Volume* volume_;
};

class FileSource final : public PackSource {
  public:
    FileSource(FileLayout layout, const Volume& described) : layout_(std::move(layout)) {
        description = described;
        file_ = open(layout_.file.c_str(), O_RDONLY | O_CLOEXEC);
        if (file_ < 0) fail("{}: cannot be read: {}", layout_.file, std::strerror(errno));
    }
    ~FileSource() override { close(file_); }
    FileSource(const FileSource&) = delete;
    FileSource& operator=(const FileSource&) = delete;

    void read(const glm::ivec3& low, const glm::ivec3& size, std::span<float> out) const override {
        const glm::i64vec3 dims(description.geometry.dims);
        const bool whole_rows = size.x == dims.x;
        const int rows = whole_rows ? size.y : 1;  // contiguous in the file
        const auto run = static_cast<std::size_t>(size.x) * static_cast<std::size_t>(rows);
        std::vector<char> bytes(run * size_of(layout_.type));
        const StoredSamples stored{.type = layout_.type,
                                   .data = bytes.data(),
                                   .swapped = layout_.swapped,
                                   .slope = layout_.slope,
                                   .intercept = layout_.intercept};
        float* to = out.data();
        for (int z = low.z; z < low.z + size.z; ++z)
            for (int y = low.y; y < low.y + size.y; y += rows) {
                fill(bytes, static_cast<std::size_t>((z * dims.y + y) * dims.x + low.x));
                convert_stored(stored, run, to);
                to += run;
            }
    }

  private:
    void fill(std::vector<char>& bytes, std::size_t first_sample) const {
        const std::size_t item = size_of(layout_.type), begin = layout_.offset + first_sample * item;
        for (std::size_t done = 0; done < bytes.size();) {
            const ssize_t count =
                pread(file_, bytes.data() + done, bytes.size() - done, static_cast<off_t>(begin + done));
            if (count < 0 && errno == EINTR) continue;
            if (count < 0) fail("{}: cannot be read: {}", layout_.file, std::strerror(errno));
            if (count == 0) fail("{}: truncated: it ends at byte {}", layout_.file, begin + done);
            done += static_cast<std::size_t>(count);
        }
    }

    FileLayout layout_;
    int file_ = -1;
};

bool is_nrrd(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::array<char, 5> magic{};
    file.read(magic.data(), magic.size());
    return std::string_view(magic.data(), magic.size()) == "NRRD0";
}

/// Whether one of three slices looks like labels, which are recognised in memory, or has numbers that floats cannot
/// represent.
bool may_be_labels(const PackSource& source) {
    const VolumeGeometry& geometry = source.description.geometry;
    if (geometry.voxel_count() > kMaxVoxels) return false;
    Volume slice;
    slice.geometry.dims = {geometry.dims.x, geometry.dims.y, 1};
    slice.values.resize(slice.geometry.voxel_count());
    for (int quarter = 1; quarter < 4; ++quarter) {
        source.read({0, 0, quarter * (geometry.dims.z - 1) / 4}, slice.geometry.dims, slice.values);
        const bool whole = std::ranges::all_of(slice.values, [](float v) { return v == std::floor(v); });
        const auto [low, high] = std::ranges::minmax(slice.values);
        slice.min_value = low;
        slice.max_value = high;
        if (whole && (std::max(-low, high) > kLargestExact || labels_of(slice))) return true;
    }
    return false;
}

}  // namespace

std::unique_ptr<PackSource> file_source(const FileLayout& layout, const Volume& description) {
    const std::size_t needed = description.geometry.voxel_count() * size_of(layout.type);
    std::error_code error;
    const std::size_t size = std::filesystem::file_size(layout.file, error);
    if (error) fail("{}: cannot be read: {}", layout.file, error.message());
    if (size < layout.offset || size - layout.offset < needed)
        fail("{}: truncated: {} bytes of voxels, expected {}", layout.file,
             size < layout.offset ? 0 : size - layout.offset, needed);
    return std::make_unique<FileSource>(layout, description);
}

std::unique_ptr<PackSource> memory_source(const Volume& volume) {
    return std::make_unique<MemorySource>(volume);
}

std::unique_ptr<PackSource> open_source(const std::string& path, const LoadOptions& options) {
    if (is_builtin(path)) return std::make_unique<AnalyticSource>(path);
    std::error_code error;
    if (std::filesystem::is_regular_file(path, error) && !options.component && !options.frame) {
        Volume description;
        std::optional<FileLayout> layout;
        if (!options.raw.empty())
            layout = raw_layout(path, options, description);
        else if (is_nrrd(path))
            layout = nrrd_layout(path, description);
        else if (path.ends_with(".mha") || path.ends_with(".mhd"))
            layout = meta_layout(path, description);
        // Values that no header declares are looked for in the samples.
        if (layout && !options.no_data) {
            apply_spacing(description, options);
            auto source = file_source(*layout, description);
            if (!may_be_labels(*source)) return source;
        }
    }
    Volume volume = load_volume(path, options);
    if (volume.packed) fail("{}: is a packed volume already", path);
    return std::make_unique<MemorySource>(std::move(volume));
}

}  // namespace edgesplat::detail

#include "engine/volume/sample_source.h"

#include <algorithm>

#include "engine/volume/labels.h"
#include "engine/volume/packed_volume.h"

namespace edgesplat {
namespace {

class InMemory : public SampleSource {
  public:
    explicit InMemory(std::shared_ptr<const Volume> volume) : volume_(std::move(volume)) {}
    const VolumeGeometry& geometry() const override { return volume_->geometry; }

    ValueRange range(const glm::ivec3& low, const glm::ivec3& size) const override {
        ValueRange out{volume_->max_value, volume_->min_value};
        for_rows(low, size, [&](std::size_t first, std::size_t) {
            const float* row = &volume_->values[first];
            const auto [least, most] = std::minmax_element(row, row + size.x);
            out.low = std::min(out.low, *least);
            out.high = std::max(out.high, *most);
            for (std::size_t i = first; volume_->no_data && i < first + static_cast<std::size_t>(size.x); ++i)
                out.complete = out.complete && volume_->has_data(i);
        });
        return out;
    }

    void read(const glm::ivec3& low, const glm::ivec3& size, std::span<float> out) const override {
        for_rows(low, size, [&](std::size_t first, std::size_t number) {
            const auto width = static_cast<std::size_t>(size.x);
            for (std::size_t i = 0; i < width; ++i)
                out[number * width + i] = volume_->sample(first + i);
        });
    }

  private:
    template <typename Body>
    void for_rows(const glm::ivec3& low, const glm::ivec3& size, const Body& body) const {
        const glm::u64vec3 dims(volume_->geometry.dims), first(low);
        std::size_t number = 0;
        for (std::size_t z = first.z; z < first.z + static_cast<std::size_t>(size.z); ++z)
            for (std::size_t y = first.y; y < first.y + static_cast<std::size_t>(size.y); ++y)
                body((z * dims.y + y) * dims.x + first.x, number++);
    }

    std::shared_ptr<const Volume> volume_;
};

class InFile : public SampleSource {
  public:
    InFile(std::shared_ptr<const PackedVolume> file, int level) : file_(std::move(file)), level_(level) {}
    const VolumeGeometry& geometry() const override { return file_->geometry(level_); }
    ValueRange range(const glm::ivec3& low, const glm::ivec3& size) const override {
        const PackedVolume::Range range = file_->range(level_, low, size);
        return {range.low, range.high, true};
    }
    void read(const glm::ivec3& low, const glm::ivec3& size, std::span<float> out) const override {
        file_->read(level_, low, size, out);
    }

  private:
    std::shared_ptr<const PackedVolume> file_;
    int level_;
};

constexpr int kCoarsestAxis = 64;

}  // namespace

std::shared_ptr<const SampleSource> source_of(std::shared_ptr<const Volume> volume, int level) {
    if (volume->packed) return std::make_shared<InFile>(volume->packed, level);
    return std::make_shared<InMemory>(std::move(volume));
}

int level_count(const Volume& volume) {
    if (volume.packed) return volume.packed->levels();
    int levels = 1;
    for (glm::ivec3 dims = volume.geometry.dims; std::max({dims.x, dims.y, dims.z}) > kCoarsestAxis; ++levels)
        dims = (dims + 1) / 2;
    return levels;
}

VolumeGeometry level_geometry(const VolumeGeometry& geometry, int level) {
    VolumeGeometry out = geometry;
    const int factor = 1 << level;
    out.dims = (geometry.dims + (factor - 1)) / factor;
    out.origin = geometry.to_world(glm::dvec3(0.5 * (factor - 1)));
    out.index_to_world_axes *= static_cast<double>(factor);
    return out;
}

Volume halved(const Volume& volume) {
    Volume out;
    out.geometry = level_geometry(volume.geometry, 1);
    out.in_patient = volume.in_patient;
    out.min_value = volume.min_value;
    out.max_value = volume.max_value;
    out.name = volume.name;
    out.stored_type = volume.stored_type;
    out.checksum = volume.checksum;
    out.notes = volume.notes;
    out.value_scale = volume.value_scale;
    const auto no_data = volume.no_data ? std::make_shared<std::vector<bool>>() : nullptr;
    if (volume.shown_labels) {
        out.labels = volume.labels;
        out.shown_labels =
            sorted_labels(halved_labels(volume.shown_labels->at, volume.geometry.dims), volume.shown_labels->on_scan);
    }
    out.values.reserve(out.geometry.voxel_count());
    const glm::ivec3 last = volume.geometry.dims - 1;
    glm::ivec3 p;
    for (p.z = 0; p.z < out.geometry.dims.z; ++p.z)
        for (p.y = 0; p.y < out.geometry.dims.y; ++p.y)
            for (p.x = 0; p.x < out.geometry.dims.x; ++p.x) {
                const glm::ivec3 low = 2 * p, high = glm::min(low + 1, last);
                double sum = 0;
                int count = 0;
                for (int z = low.z; z <= high.z; ++z)
                    for (int y = low.y; y <= high.y; ++y)
                        for (int x = low.x; x <= high.x; ++x)
                            if (volume.has_data({x, y, z})) {
                                sum += static_cast<double>(volume.at(x, y, z));
                                ++count;
                            }
                const glm::ivec3 size = high - low + 1;
                const bool enough = 2 * count >= size.x * size.y * size.z;
                if (no_data) no_data->push_back(!enough);
                out.values.push_back(enough ? static_cast<float>(sum / count) : volume.min_value);
            }
    out.no_data = no_data;
    return out;
}

}  // namespace edgesplat

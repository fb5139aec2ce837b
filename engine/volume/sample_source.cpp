#include "engine/volume/sample_source.h"

#include <algorithm>

#include "engine/volume/packed_volume.h"

namespace edgesplat {
namespace {

class InMemory : public SampleSource {
  public:
    explicit InMemory(std::shared_ptr<const Volume> volume) : volume_(std::move(volume)) {}
    const VolumeGeometry& geometry() const override { return volume_->geometry; }

    ValueRange range(const glm::ivec3& low, const glm::ivec3& size) const override {
        ValueRange out{volume_->max_value, volume_->min_value};
        for_rows(low, size, [&](const float* row, std::size_t) {
            const auto [least, most] = std::minmax_element(row, row + size.x);
            out.low = std::min(out.low, *least);
            out.high = std::max(out.high, *most);
        });
        return out;
    }

    void read(const glm::ivec3& low, const glm::ivec3& size, std::span<float> out) const override {
        for_rows(low, size, [&](const float* row, std::size_t number) {
            std::copy_n(row, size.x, &out[number * static_cast<std::size_t>(size.x)]);
        });
    }

  private:
    template <typename Body>
    void for_rows(const glm::ivec3& low, const glm::ivec3& size, const Body& body) const {
        const glm::u64vec3 dims(volume_->geometry.dims), first(low);
        std::size_t number = 0;
        for (std::size_t z = first.z; z < first.z + static_cast<std::size_t>(size.z); ++z)
            for (std::size_t y = first.y; y < first.y + static_cast<std::size_t>(size.y); ++y)
                body(&volume_->values[(z * dims.y + y) * dims.x + first.x], number++);
    }

    std::shared_ptr<const Volume> volume_;
};

class InFile : public SampleSource {
  public:
    InFile(std::shared_ptr<const PackedVolume> file, int level) : file_(std::move(file)), level_(level) {}
    const VolumeGeometry& geometry() const override { return file_->geometry(level_); }
    ValueRange range(const glm::ivec3& low, const glm::ivec3& size) const override {
        const PackedVolume::Range range = file_->range(level_, low, size);
        return {range.low, range.high};
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
    out.values.reserve(out.geometry.voxel_count());
    const glm::ivec3 last = volume.geometry.dims - 1;
    glm::ivec3 p;
    for (p.z = 0; p.z < out.geometry.dims.z; ++p.z)
        for (p.y = 0; p.y < out.geometry.dims.y; ++p.y)
            for (p.x = 0; p.x < out.geometry.dims.x; ++p.x) {
                const glm::ivec3 low = 2 * p, high = glm::min(low + 1, last);
                double sum = 0;
                for (int z = low.z; z <= high.z; ++z)
                    for (int y = low.y; y <= high.y; ++y)
                        for (int x = low.x; x <= high.x; ++x)
                            sum += static_cast<double>(volume.at(x, y, z));
                const glm::ivec3 count = high - low + 1;
                out.values.push_back(static_cast<float>(sum / (count.x * count.y * count.z)));
            }
    return out;
}

}  // namespace edgesplat

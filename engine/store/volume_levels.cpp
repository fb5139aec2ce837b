#include "engine/store/volume_levels.h"

#include "engine/volume/sample_source.h"

namespace edgesplat {
namespace {

/// A level's metadata as a volume without samples.
std::shared_ptr<const Volume> outline(const Volume& volume, int level) {
    const auto out = std::make_shared<Volume>();
    out->geometry = level_geometry(volume.geometry, level);
    out->in_patient = volume.in_patient;
    out->min_value = volume.min_value;
    out->max_value = volume.max_value;
    out->name = volume.name;
    out->stored_type = volume.stored_type;
    out->value_scale = volume.value_scale;
    out->checksum = volume.checksum;
    return out;
}

}  // namespace

void VolumeLevels::set(std::shared_ptr<const Volume> volume) {
    levels_ = {std::move(volume)};
}

const std::shared_ptr<const Volume>& VolumeLevels::at(int level) {
    while (static_cast<int>(levels_.size()) <= level) {
        const int next = static_cast<int>(levels_.size());
        levels_.push_back(original()->values.empty() ? outline(*original(), next)
                                                     : std::make_shared<const Volume>(halved(*levels_.back())));
    }
    return levels_[static_cast<std::size_t>(level)];
}

int VolumeLevels::count() const {
    return level_count(*original());
}

int VolumeLevels::coarse() const {
    int level = 0;
    while (level + 1 < count() && level_geometry(original()->geometry, level).voxel_count() > kCoarseVoxels)
        ++level;
    return level;
}

}  // namespace edgesplat

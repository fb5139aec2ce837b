#include "engine/store/volume_store.h"

#include "engine/plan/resource_table.h"
#include "engine/volume/filters.h"
#include "engine/volume/labels.h"
#include "engine/volume/packed_volume.h"

namespace edgesplat {

CollectionBlock whole_block(const glm::ivec3& dims) {
    return {glm::ivec3(0), dims, glm::ivec3(0), dims};
}

bool VolumeStore::hold(std::shared_ptr<const Volume> volume, int level) {
    if (volume == volume_) return false;
    volume_ = std::move(volume);
    level_ = level;
    images_ = {};
    ranges_ = {};
    changed_.reset();
    behind_.reset();
    return true;
}

bool VolumeStore::hold_in_blocks(bool blocks) {
    if (blocks == in_blocks_) return false;
    in_blocks_ = blocks;
    images_ = {};
    ranges_ = {};
    return true;
}

void VolumeStore::change(std::shared_ptr<const Volume> next, const VoxelBox& box) {
    volume_ = std::move(next);
    // Equal samples keep their spline coefficients, which rays may need for every picture.
    if (box.empty()) return;
    release_coefficients();
    ranges_ = {};
    for (std::optional<VoxelBox>* boxes : {&changed_, &behind_}) {
        if (!*boxes) boxes->emplace();
        (*boxes)->add(box);
    }
}

void VolumeStore::make(gpu::GpuImage VolumeImages::*image, const glm::ivec3& size) {
    const auto& row = row_of(image);
    images_.*image = gpu::GpuImage(session_->device(), row.shape(size), row.text.name);
}

const BrickRanges& VolumeStore::ranges() {
    if (ranges_.empty()) ranges_ = BrickRanges(*volume_);
    return ranges_;
}

bool VolumeStore::provide() {
    const gpu::Device& device = session_->device();
    if (!images_.volume) {
        const auto field = scaled_field(*volume_);
        make(&VolumeImages::volume, volume_->geometry.dims);
        upload_image(session_->commands(), device, images_.volume, field.data(), sizeof(float));
    } else if (behind_) {
        const std::vector<float> samples = scaled_box(*volume_, *behind_);
        upload_box(session_->commands(), device, images_.volume, behind_->low, behind_->size(), samples.data(),
                   sizeof(float));
    } else {
        return false;
    }
    behind_.reset();
    return true;
}

bool VolumeStore::provide_coefficients() {
    if (images_.coefficients) return false;
    const glm::ivec3 dims = volume_->geometry.dims;
    const auto coefficients = bspline_coefficients(scaled_field(*volume_), dims);
    make(&VolumeImages::coefficients, dims);
    upload_image(session_->commands(), session_->device(), images_.coefficients, coefficients.data(), sizeof(float));
    return true;
}

bool VolumeStore::provide_labels() {
    if (images_.labels) return false;
    const glm::ivec3 dims = volume_->geometry.dims;
    make(&VolumeImages::labels, dims);
    const ShownLabels& shown = *volume_->shown_labels;
    const auto of_scan = shown.on_scan ? drawn_numbers(shown, dims, glm::ivec3(0), dims) : std::vector<std::uint32_t>();
    upload_image(session_->commands(), session_->device(), images_.labels,
                 shown.on_scan ? of_scan.data() : shown.at.data(), sizeof(std::uint32_t));
    return true;
}

void VolumeStore::hold_blocks(const glm::ivec3& largest, bool coefficients, bool labels) {
    images_ = {};
    make(&VolumeImages::volume, largest);
    if (coefficients) make(&VolumeImages::coefficients, largest);
    if (labels) make(&VolumeImages::labels, largest);
    session_->commands().run([&] {
        session_->commands().prepare({&images_.volume});
        if (coefficients) session_->commands().prepare({&images_.coefficients});
        if (labels) session_->commands().prepare({&images_.labels});
    });
}

void VolumeStore::load(const CollectionBlock& block, std::span<const float> samples) {
    const auto upload = [&](const gpu::GpuImage& image, const void* texels) {
        upload_block(session_->commands(), session_->device(), image, block.size, texels, sizeof(float));
    };
    upload(images_.volume, samples.data());
    if (images_.labels)
        upload(images_.labels,
               drawn_numbers(*volume_->shown_labels, volume_->geometry.dims, block.low, block.size).data());
    if (!images_.coefficients) return;
    upload(images_.coefficients, bspline_coefficients({samples.begin(), samples.end()}, block.size).data());
}

}  // namespace edgesplat

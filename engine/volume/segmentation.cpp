#include "engine/volume/segmentation.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "engine/error.h"
#include "engine/volume/labels.h"
#include "engine/volume/packed_volume.h"
#include "engine/volume/parallel.h"
#include "engine/volume/smooth_labels.h"

namespace edgesplat {
namespace {

// Voxels over which matter fades on the inner side of a cut.
constexpr double kFade = 0.5;

/// The labels without the background, and the number of each of the segmentation's places among them; 0: none.
struct Numbering {
    std::shared_ptr<LabelTable> table = std::make_shared<LabelTable>();
    std::vector<std::uint32_t> numbers;
};

Numbering numbering(const Volume& segmentation, const LabelTable& labels) {
    const std::size_t background = background_label(segmentation, labels);
    Numbering result;
    result.table->is_signed = labels.is_signed;
    for (std::size_t place = 0; place < labels.labels.size(); ++place) {
        if (place != background) result.table->labels.push_back(labels.labels[place]);
        result.numbers.push_back(place == background ? 0 : static_cast<std::uint32_t>(result.table->labels.size()));
    }
    return result;
}

/// Calls look(offset, voxel) for the voxels of a slab of slices on each thread.
template <typename Look>
void for_voxels(const glm::ivec3& dims, const Look& look) {
    parallel_for(dims.z, [&](int begin, int end) {
        for (int z = begin; z < end; ++z) {
            auto at = static_cast<std::size_t>(z) * static_cast<std::size_t>(dims.y) * static_cast<std::size_t>(dims.x);
            for (int y = 0; y < dims.y; ++y)
                for (int x = 0; x < dims.x; ++x)
                    look(at++, glm::ivec3(x, y, z));
        }
    });
}

std::string extent_of(const Volume& volume) {
    const glm::dvec3 a = volume.geometry.to_world(glm::dvec3(-0.5));
    const glm::dvec3 b = volume.geometry.to_world(glm::dvec3(volume.geometry.dims) - 0.5);
    return fmt::format("from {:.4g}, {:.4g}, {:.4g} to {:.4g}, {:.4g}, {:.4g} mm", a.x, a.y, a.z, b.x, b.y, b.z);
}

bool same_grid(const VolumeGeometry& a, const VolumeGeometry& b) {
    constexpr double kClose = 1e-3;  // voxels
    if (a.dims != b.dims) return false;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 at = glm::dvec3(a.dims) * glm::dvec3(corner & 1, corner >> 1 & 1, corner >> 2);
        if (glm::length(b.to_index(a.to_world(at)) - at) > kClose) return false;
    }
    return true;
}

}  // namespace

void add_segmentation(Volume& scan, const Volume& segmentation) {
    const auto fail_for = [&](const std::string& expected) {
        fail("{}: volume.segmentation (--segmentation): {}", segmentation.name, expected);
    };
    if (segmentation.packed && segmentation.labels) return add_segmentation(scan, load_level(segmentation, 0));
    if (scan.packed || segmentation.packed) fail_for("expected volumes that are not packed");
    const auto labels = labels_of(segmentation);
    if (!labels)
        fail_for(fmt::format("expected a segmentation of 2 to {} whole numbers without transitions", kMaxRankedLabels));
    Numbering named = numbering(segmentation, *labels);
    const VolumeGeometry& grid = segmentation.geometry;
    const glm::dmat3 to_grid = glm::inverse(grid.index_to_world_axes);
    const glm::dmat3 axes = to_grid * scan.geometry.index_to_world_axes;
    const glm::dvec3 begin = to_grid * (scan.geometry.origin - grid.origin);
    std::vector<std::uint32_t> at(scan.values.size());
    for_voxels(scan.geometry.dims, [&](std::size_t offset, const glm::ivec3& voxel) {
        const glm::dvec3 place = glm::round(begin + axes * glm::dvec3(voxel));
        if (glm::any(glm::lessThan(place, glm::dvec3(0))) ||
            glm::any(glm::greaterThanEqual(place, glm::dvec3(grid.dims))))
            return;
        const glm::ivec3 there(place);
        const std::size_t sample = segmentation.index_of(there.x, there.y, there.z);
        if (segmentation.has_data(sample))
            at[offset] = named.numbers[place_of_label(*labels, segmentation.values[sample])];
    });
    auto shown = sorted_labels(std::move(at), true);
    if (shown->largest.empty())
        fail_for(fmt::format("none of its labels lies in {}, which reaches {}; the segmentation reaches {}", scan.name,
                             extent_of(scan), extent_of(segmentation)));
    if (scan.in_patient != segmentation.in_patient)
        scan.warnings.push_back(
            fmt::format("Only the {} says how its axes lie in the patient; the labels may be in the wrong place.",
                        scan.in_patient ? "scan" : "segmentation"));
    const std::size_t lost = named.table->labels.size() - shown->largest.size();
    if (!same_grid(scan.geometry, grid))
        scan.notes.push_back("The segmentation has another grid: each voxel has the label at its centre.");
    if (lost > 0)
        scan.warnings.push_back(fmt::format("{} of the segmentation's {} labels have no voxel of the scan.", lost,
                                            named.table->labels.size()));
    scan.warnings.insert(scan.warnings.end(), segmentation.warnings.begin(), segmentation.warnings.end());
    scan.labels = std::move(named.table);
    scan.shown_labels = std::move(shown);
    finish_volume(scan);
}

namespace {

/// Whether each voxel's matter is shown, 0 or 1. A voxel without a label belongs to the nearest label at most a voxel
/// away; a shown one is preferred.
std::vector<std::uint32_t> shown_voxels(const Volume& scan, const std::vector<bool>& shown, bool unlabelled) {
    const std::vector<std::uint32_t>& numbers = scan.shown_labels->at;
    const glm::ivec3 dims = scan.geometry.dims;
    std::vector<std::uint32_t> kept(numbers.size());
    for_voxels(dims, [&](std::size_t at, const glm::ivec3& p) {
        if (numbers[at] > 0) {
            kept[at] = shown[numbers[at] - 1] ? 1 : 0;
            return;
        }
        kept[at] = unlabelled ? 1 : 0;
        bool found = false;
        int nearest = 2;  // along edges and sides of voxels
        for (int i = 0; i < 27; ++i) {
            const glm::ivec3 way = glm::ivec3(i % 3, i / 3 % 3, i / 9) - 1;
            const glm::ivec3 there = p + way;
            if (glm::any(glm::lessThan(there, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(there, dims))) continue;
            const std::uint32_t number = numbers[scan.index_of(there.x, there.y, there.z)];
            const int distance = std::abs(way.x) + std::abs(way.y) + std::abs(way.z);
            if (number == 0 || distance > nearest) continue;
            const std::uint32_t is_shown = shown[number - 1] ? 1 : 0;
            kept[at] = found && distance == nearest ? std::max(kept[at], is_shown) : is_shown;
            nearest = distance;
            found = true;
        }
    });
    return kept;
}

}  // namespace

Volume with_labels_shown(const Volume& scan, const std::vector<bool>& shown, bool unlabelled, double iso) {
    const glm::ivec3 dims = scan.geometry.dims;
    const std::vector<std::uint32_t> kept = shown_voxels(scan, shown, unlabelled);
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < kept.size(); ++i) {
        const double above = static_cast<double>(scan.values[i]) - iso;
        if (kept[i] == 0 || !(above > 0)) continue;
        sum += above;
        ++count;
    }
    if (count == 0)
        fail("{}: volume.only, volume.hide (--only, --hide): the labels that are left have no value above {:g}",
             scan.name, scan.in_file_unit(iso));
    const double contrast = sum / static_cast<double>(count);
    const std::vector<float> depth = depth_in_labels(kept, dims);
    Volume result = scan;
    std::vector<std::uint32_t> numbers(kept.size());
    for_voxels(dims, [&](std::size_t at, const glm::ivec3&) {
        const std::uint32_t number = scan.shown_labels->at[at];
        numbers[at] = number > 0 && shown[number - 1] ? number : 0;
        // Above 0 where matter stays: 1 in it, 0 where it is cut.
        const double inside = std::clamp(static_cast<double>(depth[at]) / kFade, -1.0, 1.0);
        const double above = static_cast<double>(scan.values[at]) - iso;
        const double matter = above > 0 ? above * std::max(inside, 0.0) : above;
        result.values[at] = static_cast<float>(iso + matter + contrast * std::min(inside, 0.0));
    });
    result.shown_labels = sorted_labels(std::move(numbers), true);
    finish_volume(result);
    return result;
}

}  // namespace edgesplat

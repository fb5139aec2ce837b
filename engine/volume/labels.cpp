#include "engine/volume/labels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>

#include "engine/error.h"
#include "engine/volume/grid.h"
#include "engine/volume/parallel.h"
#include "engine/volume/smooth_labels.h"

namespace edgesplat {
namespace {

// Maximum share of in-between values among voxels with two distant neighbours; they occur at corners between labels.
constexpr double kMostBetween = 0.1;
// From this number of labels on, measured values in whole numbers are more likely than labels, and must be excluded.
constexpr std::size_t kManyLabels = 256;
// Of many labels: least share of voxels whose next voxel along x has the same label, and least mean difference of the
// others' ranks, relative to the number of labels.
constexpr double kLeastAlike = 0.5, kLeastApart = 0.03;
// Largest magnitude of a whole number that is a label: floats represent smaller ones exactly.
constexpr float kLargestNumber = 16777216.0F;

bool has_data(const Volume& volume, std::size_t at) {
    return !volume.no_data || !(*volume.no_data)[at];
}

/// The distinct values in every `stride`-th slice, ascending; nullopt if they are not whole numbers or too many.
std::optional<std::vector<float>> whole_numbers(const Volume& volume, int stride) {
    const float low = std::floor(volume.min_value), high = volume.max_value;
    if (!(low >= -kLargestNumber && high <= kLargestNumber)) return std::nullopt;
    std::vector<bool> seen(static_cast<std::size_t>(high - low) + 1);
    std::size_t count = 0;
    float last = std::nanf("");
    const std::size_t slice = volume.values.size() / static_cast<std::size_t>(volume.geometry.dims.z);
    for (std::size_t begin = 0; begin < volume.values.size(); begin += slice * static_cast<std::size_t>(stride))
        for (std::size_t at = begin; at < begin + slice; ++at) {
            const float sample = volume.values[at];
            if (sample == last || !has_data(volume, at)) continue;
            last = sample;
            if (sample != std::round(sample)) return std::nullopt;
            auto&& here = seen[static_cast<std::size_t>(sample - low)];
            if (here) continue;
            here = true;
            if (++count > kMaxRankedLabels) return std::nullopt;
        }
    std::vector<float> found;
    for (std::size_t i = 0; i < seen.size(); ++i)
        if (seen[i]) found.push_back(low + static_cast<float>(i));
    return found;
}

/// How the values of neighbouring voxels differ, by their ranks among all values.
struct RankDifferences {
    std::uint64_t apart = 0, between = 0;             ///< of three in a row
    std::uint64_t alike = 0, pairs = 0, far_sum = 0;  ///< of two along x
};

bool look_like_labels(const RankDifferences& found, std::size_t labels) {
    if (static_cast<double>(found.between) > kMostBetween * static_cast<double>(found.apart)) return false;
    if (labels <= kManyLabels) return true;
    const auto unlike = static_cast<double>(found.pairs - found.alike);
    return static_cast<double>(found.alike) >= kLeastAlike * static_cast<double>(found.pairs) &&
           static_cast<double>(found.far_sum) >= kLeastApart * static_cast<double>(labels) * unlike;
}

/// Counts in every `stride`-th slice, whose values must be given; along z only with stride 1.
RankDifferences rank_differences(const Volume& volume, const std::vector<float>& values, int stride) {
    std::vector<std::uint32_t> ranks(static_cast<std::size_t>(values.back() - values.front()) + 1);
    for (std::size_t i = 0; i < values.size(); ++i)
        ranks[static_cast<std::size_t>(values[i] - values.front())] = static_cast<std::uint32_t>(i);
    // Samples without data have the smallest sample's value, which may be none of `values`.
    const auto rank = [&](float sample) {
        return static_cast<std::int64_t>(ranks[static_cast<std::size_t>(std::max(sample - values.front(), 0.0F))]);
    };
    const glm::ivec3 dims = volume.geometry.dims;
    RankDifferences found;
    const auto look = [&](float a, float b, float c) {
        if (a == c || std::abs(rank(a) - rank(c)) < 2) return;
        ++found.apart;
        if (std::min(a, c) < b && b < std::max(a, c)) ++found.between;
    };
    for (int z = 0; z < dims.z; z += stride)
        for (int y = 0; y < dims.y; ++y)
            for (int x = 0; x < dims.x; ++x) {
                const float here = volume.at(x, y, z);
                if (x + 2 < dims.x) look(here, volume.at(x + 1, y, z), volume.at(x + 2, y, z));
                if (y + 2 < dims.y) look(here, volume.at(x, y + 1, z), volume.at(x, y + 2, z));
                if (stride == 1 && z + 2 < dims.z) look(here, volume.at(x, y, z + 1), volume.at(x, y, z + 2));
                if (x + 1 == dims.x) continue;
                const float next = volume.at(x + 1, y, z);
                ++found.pairs;
                found.alike += here == next ? 1 : 0;
                if (here != next) found.far_sum += static_cast<std::uint64_t>(std::abs(rank(here) - rank(next)));
            }
    return found;
}

}  // namespace

std::shared_ptr<const LabelTable> labels_of(const Volume& volume) {
    if (volume.labels) return volume.labels;
    if (volume.values.empty()) return nullptr;
    // A few slices reject nearly all measured values.
    constexpr int kFewSlices = 8;
    const int stride = volume.geometry.dims.z / kFewSlices;
    if (stride > 1) {
        const auto some = whole_numbers(volume, stride);
        if (!some ||
            (some->size() > kManyLabels && !look_like_labels(rank_differences(volume, *some, stride), some->size())))
            return nullptr;
    }
    const auto values = whole_numbers(volume, 1);
    if (!values || values->size() < 2 || !look_like_labels(rank_differences(volume, *values, 1), values->size()))
        return nullptr;
    auto table = std::make_shared<LabelTable>();
    table->is_signed = values->front() < 0;
    for (const float value : *values)
        table->labels.push_back({static_cast<std::uint64_t>(static_cast<std::int64_t>(value)), value, {}, {}});
    return table;
}

bool has_ranks(const LabelTable& table) {
    return std::ranges::any_of(table.labels, [&](const Label& label) {
        return static_cast<double>(label.value) != (table.is_signed
                                                        ? static_cast<double>(static_cast<std::int64_t>(label.id))
                                                        : static_cast<double>(label.id));
    });
}

std::size_t place_of_label(const LabelTable& table, float sample) {
    const auto at = std::ranges::lower_bound(table.labels, sample, {}, &Label::value);
    return static_cast<std::size_t>(at - table.labels.begin());
}

std::size_t background_label(const Volume& volume, const LabelTable& table) {
    if (volume.has_segmentation()) return table.labels.size();
    std::vector<std::size_t> count(table.labels.size(), 0);
    const glm::ivec3 dims = volume.geometry.dims;
    for (int z = 0; z < dims.z; ++z)
        for (int y = 0; y < dims.y; ++y) {
            const bool side = z == 0 || z + 1 == dims.z || y == 0 || y + 1 == dims.y;
            for (int x = 0; x < dims.x; x += side ? 1 : std::max(dims.x - 1, 1))
                ++count[std::min(place_of_label(table, volume.at(x, y, z)), count.size() - 1)];
        }
    const auto zero = std::ranges::find(table.labels, std::uint64_t{0}, &Label::id);
    if (zero != table.labels.end()) {
        const auto place = static_cast<std::size_t>(zero - table.labels.begin());
        if (count[place] > 0) return place;
    }
    return static_cast<std::size_t>(std::ranges::max_element(count) - count.begin());
}

Volume drawn_labels(const Volume& volume, std::shared_ptr<const LabelTable> table, const std::vector<bool>& shown) {
    Volume result = volume;
    std::vector<std::uint32_t> labels(volume.values.size());
    float last = std::nanf("");
    std::uint32_t number = 0;
    bool any = false;
    for (std::size_t at = 0; at < volume.values.size(); ++at) {
        if (volume.values[at] != last) {
            last = volume.values[at];
            const std::size_t place = place_of_label(*table, last);
            number = place < shown.size() && shown[place] ? static_cast<std::uint32_t>(place) + 1 : 0;
        }
        labels[at] = has_data(volume, at) ? number : 0;
        any = any || labels[at] > 0;
    }
    if (!any) fail("{}: no voxel has a label that is shown", volume.name);
    result.values = smoothed_mask(labels, volume.geometry.dims);
    result.no_data = nullptr;
    result.labels = std::move(table);
    result.shown_labels = sorted_labels(std::move(labels));
    finish_volume(result);
    return result;
}

std::shared_ptr<const ShownLabels> sorted_labels(std::vector<std::uint32_t> at, bool on_scan) {
    auto shown = std::make_shared<ShownLabels>();
    shown->on_scan = on_scan;
    std::vector<std::size_t> count;
    for (const std::uint32_t number : at) {
        if (number >= count.size()) count.resize(std::size_t{number} + 1);
        ++count[number];
    }
    for (std::uint32_t number = 1; number < count.size(); ++number)
        if (count[number] > 0) shown->largest.push_back(number);
    std::ranges::stable_sort(shown->largest, std::greater{}, [&](std::uint32_t number) { return count[number]; });
    shown->at = std::move(at);
    return shown;
}

Volume drawn_labels(const Volume& volume) {
    auto table = labels_of(volume);
    if (!table)
        fail("{}: volume.labels: expected a segmentation of 2 to {} whole numbers without transitions", volume.name,
             kMaxRankedLabels);
    std::vector<bool> shown(table->labels.size(), true);
    shown[background_label(volume, *table)] = false;
    return drawn_labels(volume, std::move(table), shown);
}

std::vector<std::uint32_t> labels_in_box(const std::vector<std::uint32_t>& labels, const glm::ivec3& dims,
                                         const glm::ivec3& low, const glm::ivec3& size) {
    std::vector<std::uint32_t> part;
    for (int z = low.z; z < low.z + size.z; ++z)
        for (int y = low.y; y < low.y + size.y; ++y) {
            const auto row = labels.begin() + static_cast<std::ptrdiff_t>(voxel_offset(dims, {low.x, y, z}));
            part.insert(part.end(), row, row + size.x);
        }
    return part;
}

std::vector<std::uint32_t> drawn_numbers(const ShownLabels& labels, const glm::ivec3& dims, const glm::ivec3& low,
                                         const glm::ivec3& size) {
    std::vector<std::uint32_t> numbers = labels_in_box(labels.at, dims, low, size);
    if (!labels.on_scan) return numbers;
    // Most lines along x are far from all labels.
    const glm::ivec3 first = glm::max(low - 1, glm::ivec3(0)), last = glm::min(low + size, dims - 1);
    const auto has_labels = [&](int y, int z) {
        const auto row = labels.at.begin() + static_cast<std::ptrdiff_t>(voxel_offset(dims, {first.x, y, z}));
        return std::any_of(row, row + (last.x - first.x + 1), [](std::uint32_t number) { return number > 0; });
    };
    const auto is_near = [&](const glm::ivec3& p) {
        for (int i = 0; i < 9; ++i) {
            const glm::ivec3 row = glm::clamp(p + glm::ivec3(0, i % 3 - 1, i / 3 - 1), first, last);
            if (has_labels(row.y, row.z)) return true;
        }
        return false;
    };
    parallel_for(size.z, [&](int begin, int end) {
        for (int z = begin; z < end; ++z)
            for (int y = 0; y < size.y; ++y) {
                if (!is_near(low + glm::ivec3(0, y, z))) continue;
                for (int x = 0; x < size.x; ++x)
                    numbers[voxel_offset(size, {x, y, z})] = label_near(labels, dims, low + glm::ivec3(x, y, z));
            }
    });
    return numbers;
}

std::vector<std::uint32_t> halved_labels(const std::vector<std::uint32_t>& labels, const glm::ivec3& dims) {
    const glm::ivec3 half = (dims + 1) / 2;
    std::vector<std::uint32_t> out;
    for (int z = 0; z < half.z; ++z)
        for (int y = 0; y < half.y; ++y)
            for (int x = 0; x < half.x; ++x) {
                std::array<std::uint32_t, 8> all{};
                for (int i = 0; i < 8; ++i)
                    all[static_cast<std::size_t>(i)] = labels[voxel_offset(
                        dims, glm::min(glm::ivec3(2 * x + (i & 1), 2 * y + (i >> 1 & 1), 2 * z + (i >> 2)), dims - 1))];
                std::ranges::sort(all);
                std::uint32_t best = 0;
                std::ptrdiff_t most = 0;
                for (auto at = std::ranges::upper_bound(all, 0U); at != all.end();) {
                    const auto end = std::upper_bound(at, all.end(), *at);
                    if (end - at > most) best = *at;
                    most = std::max(most, end - at);
                    at = end;
                }
                out.push_back(best);
            }
    return out;
}

std::uint32_t label_near(const ShownLabels& labels, const glm::ivec3& dims, const glm::ivec3& p) {
    const auto at = [&](const glm::ivec3& i) { return labels.at[voxel_offset(dims, i)]; };
    std::uint32_t label = at(p);
    if (label > 0) return label;
    const int reach = labels.on_scan ? 1 : 2, side = 2 * reach + 1;
    int nearest = 3 * reach * reach + 1;  // squares of voxels
    for (int i = 0; i < side * side * side; ++i) {
        const glm::ivec3 to(i % side, i / side % side, i / side / side);
        const glm::ivec3 there = glm::clamp(p + to - reach, glm::ivec3(0), dims - 1);
        const glm::ivec3 way = there - p;
        const int distance = way.x * way.x + way.y * way.y + way.z * way.z;
        if (at(there) == 0 || distance >= nearest) continue;
        label = at(there);
        nearest = distance;
    }
    return label;
}

std::uint32_t label_at(const Volume& volume, const glm::dvec3& place) {
    const glm::ivec3 dims = volume.geometry.dims, low(glm::floor(place));
    std::uint32_t found = 0;
    double nearest = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 8; ++i) {
        const glm::ivec3 voxel = low + glm::ivec3(i & 1, i >> 1 & 1, i >> 2);
        const double distance = glm::distance(place, glm::dvec3(voxel));
        if (distance >= nearest) continue;
        const std::uint32_t number = label_near(*volume.shown_labels, dims, glm::clamp(voxel, glm::ivec3(0), dims - 1));
        if (number == 0) continue;
        found = number;
        nearest = distance;
    }
    return found;
}

}  // namespace edgesplat

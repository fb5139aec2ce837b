#include "engine/volume/filters.h"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "engine/error.h"
#include "engine/volume/grid.h"
#include "engine/volume/labels.h"
#include "engine/volume/packed_internal.h"
#include "engine/volume/parallel.h"

namespace edgesplat {
namespace {

Volume like(const Volume& volume) {
    Volume result;
    result.geometry = volume.geometry;
    result.in_patient = volume.in_patient;
    result.name = volume.name;
    result.stored_type = volume.stored_type;
    result.format = volume.format;
    result.geometry_source = volume.geometry_source;
    result.length_unit = volume.length_unit;
    result.notes = volume.notes;
    result.no_data = volume.no_data;
    result.values.resize(volume.values.size());
    return result;
}

using detail::bin_of;

/// Lines side by side in memory: first the first sample of each line, then the second of each, and so on.
struct Lines {
    float* samples;
    std::size_t count;   ///< lines
    std::size_t length;  ///< samples of a line
    std::size_t stride;  ///< between successive samples of a line
    float* sample(std::size_t i) const { return samples + i * stride; }
};

/// Calls `work(lines)` for all lines of `field` (x fastest) along an axis, in parallel.
template <typename Work>
void along_axis(std::vector<float>& field, const glm::ivec3& dims, int axis, const Work& work) {
    const auto row = static_cast<std::size_t>(dims.x), slice = row * static_cast<std::size_t>(dims.y);
    const auto length = static_cast<std::size_t>(dims[axis]), stride = axis == 0 ? 1 : axis == 1 ? row : slice;
    const std::size_t together = axis == 0 ? 1 : row, apart = axis == 1 ? slice : row;
    parallel_for(static_cast<int>(field.size() / (length * together)), [&](int begin, int end) {
        for (auto group = static_cast<std::size_t>(begin); group < static_cast<std::size_t>(end); ++group)
            work(Lines{field.data() + group * apart, together, length, stride});
    });
}

/// Pivots of the equations c[i-1] + 4 c[i] + c[i+1] = 6 f[i] with c = f at both ends, by elimination from the first.
std::vector<float> spline_pivots(int length) {
    std::vector<float> pivots(static_cast<std::size_t>(length), 0.0F);
    for (std::size_t i = 1; i + 1 < pivots.size(); ++i)
        pivots[i] = 1 / (4 - pivots[i - 1]);
    return pivots;
}

/// Replaces samples by the coefficients of the interpolating spline.
void solve_lines(const Lines& lines, const std::vector<float>& pivots) {
    const std::size_t last = lines.length - 1;
    for (std::size_t i = 1; i < last; ++i) {
        const float* const before = lines.sample(i - 1);
        float* const here = lines.sample(i);
        for (std::size_t line = 0; line < lines.count; ++line)
            here[line] = pivots[i] * (6 * here[line] - before[line]);
    }
    for (std::size_t i = last; i-- > 1;) {
        const float* const behind = lines.sample(i + 1);
        float* const here = lines.sample(i);
        for (std::size_t line = 0; line < lines.count; ++line)
            here[line] -= pivots[i] * behind[line];
    }
}

}  // namespace

Volume box_filter(const Volume& volume) {
    require_samples(volume, "the box filter");
    const auto& dims = volume.geometry.dims;
    Volume result = like(volume);
    result.value_scale = volume.value_scale;
    if (volume.shown_labels) {
        result.labels = volume.labels;
        result.shown_labels = volume.shown_labels;
    }
    const auto row = static_cast<std::ptrdiff_t>(dims.x), slice = row * dims.y;
    parallel_for(dims.z, [&](int begin, int end) {
        for (int z = begin; z < end; ++z)
            for (int y = 0; y < dims.y; ++y)
                for (int x = 0; x < dims.x; ++x) {
                    double sum = 0;
                    int count = 0;
                    for (int dz = -1; dz <= 1; ++dz)
                        for (int dy = -1; dy <= 1; ++dy)
                            for (int dx = -1; dx <= 1; ++dx) {
                                const std::size_t at = volume.index_of(std::clamp(x + dx, 0, dims.x - 1),
                                                                       std::clamp(y + dy, 0, dims.y - 1),
                                                                       std::clamp(z + dz, 0, dims.z - 1));
                                if (!volume.has_data(at)) continue;
                                sum += static_cast<double>(volume.values[at]);
                                ++count;
                            }
                    result.values[static_cast<std::size_t>(z * slice + y * row + x)] =
                        static_cast<float>(sum / std::max(count, 1));
                }
    });
    finish_volume(result);
    return result;
}

Volume threshold(const Volume& volume, double iso_value) {
    require_samples(volume, "the threshold");
    Volume result = like(volume);
    std::transform(volume.values.begin(), volume.values.end(), result.values.begin(),
                   [&](float value) { return static_cast<double>(value) >= iso_value ? 1.0F : 0.0F; });
    finish_volume(result);
    return result;
}

double scaled_iso_value(const Volume& volume, double iso_value) {
    constexpr double kOutsideTheData = 1e9;
    if (iso_value <= static_cast<double>(volume.min_value)) return -kOutsideTheData;
    if (iso_value > static_cast<double>(volume.max_value)) return kOutsideTheData;
    return scaled_value(volume, iso_value);
}

Volume cropped(const Volume& volume, const glm::ivec3& low, const glm::ivec3& high) {
    require_samples(volume, "cropping");
    const glm::ivec3 dims = volume.geometry.dims;
    if (glm::any(glm::lessThan(low, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(high, dims)) ||
        glm::any(glm::lessThan(high - low, glm::ivec3(1))))
        fail("crop {},{},{} to {},{},{}: expected at least 2 voxels along each axis within {} x {} x {}", low.x, low.y,
             low.z, high.x, high.y, high.z, dims.x, dims.y, dims.z);
    Volume result = volume;
    result.geometry.dims = high - low + 1;
    result.geometry.origin = volume.geometry.to_world(glm::dvec3(low));
    result.values.clear();
    result.no_data.reset();
    for (int z = low.z; z <= high.z; ++z)
        for (int y = low.y; y <= high.y; ++y)
            for (int x = low.x; x <= high.x; ++x)
                result.values.push_back(volume.sample(volume.index_of(x, y, z)));
    if (volume.shown_labels)
        result.shown_labels = sorted_labels(labels_in_box(volume.shown_labels->at, dims, low, high - low + 1),
                                            volume.shown_labels->on_scan);
    finish_volume(result);
    return result;
}

std::vector<float> scaled_field(const Volume& volume) {
    require_samples(volume, "the scaled field");
    std::vector<float> field(volume.values.size());
    const std::size_t slice = volume.index_of(0, 0, 1);
    parallel_for(volume.geometry.dims.z, [&](int begin, int end) {
        for (std::size_t i = static_cast<std::size_t>(begin) * slice; i < static_cast<std::size_t>(end) * slice; ++i)
            field[i] = scaled_sample(volume, volume.sample(i));
    });
    return field;
}

std::vector<float> scaled_box(const Volume& volume, const VoxelBox& box) {
    require_samples(volume, "the scaled field");
    std::vector<float> field;
    field.reserve(box.count());
    for (int z = box.low.z; z <= box.high.z; ++z)
        for (int y = box.low.y; y <= box.high.y; ++y)
            for (int x = box.low.x; x <= box.high.x; ++x)
                field.push_back(scaled_sample(volume, volume.sample(volume.index_of(x, y, z))));
    return field;
}

std::vector<float> bspline_coefficients(const std::vector<float>& field, const glm::ivec3& dims) {
    if (dims.x < 1 || dims.y < 1 || dims.z < 1 ||
        field.size() !=
            static_cast<std::size_t>(dims.x) * static_cast<std::size_t>(dims.y) * static_cast<std::size_t>(dims.z))
        fail("B-spline coefficients: {} samples for dims {} x {} x {}", field.size(), dims.x, dims.y, dims.z);
    std::vector<float> coefficients = field;
    for (int axis = 0; axis < 3; ++axis) {
        const std::vector<float> pivots = spline_pivots(dims[axis]);
        along_axis(coefficients, dims, axis, [&](const Lines& lines) { solve_lines(lines, pivots); });
    }
    return coefficients;
}

SplineTaps spline_taps(double place, int size) {
    const int last = size - 1;
    const double held = std::clamp(place, 0.0, static_cast<double>(last));
    const int cell = static_cast<int>(held);
    const double t = held - cell, s = 1 - t;
    SplineTaps taps{
        {s * s * s / 6, (3 * t * t * t - 6 * t * t + 4) / 6, (3 * s * s * s - 6 * s * s + 4) / 6, t * t * t / 6},
        {-s * s / 2, (1.5 * t - 2) * t, (2 - 1.5 * s) * s, t * t / 2},
        {}};
    for (int k = 0; k < 4; ++k)
        taps.places[static_cast<std::size_t>(k)] = std::clamp(cell + k - 1, 0, last);
    for (std::array<double, 4>* w : {&taps.weights, &taps.slopes}) {
        auto& [before, first, second, behind] = *w;
        // Coefficients beyond a border are extrapolated linearly from the outermost two.
        if (cell == 0) {
            first += 2 * before;
            second -= before;
            before = 0;
        }
        if (cell == last - 1) {
            second += 2 * behind;
            first -= behind;
            behind = 0;
        }
        if (cell == last) {
            first += 2 * second;
            before -= second;
            second = 0;
        }
    }
    if (size == 1) {
        taps.weights = {0, 1, 0, 0};
        taps.slopes = {};
    }
    return taps;
}

glm::dvec4 spline_at(const std::vector<float>& coefficients, const glm::ivec3& dims, const glm::dvec3& place) {
    const SplineTaps x = spline_taps(place.x, dims.x), y = spline_taps(place.y, dims.y),
                     z = spline_taps(place.z, dims.z);
    glm::dvec4 sum(0);
    for (std::size_t k = 0; k < 4; ++k)
        for (std::size_t j = 0; j < 4; ++j) {
            const std::size_t row = voxel_offset(dims, {0, y.places[j], z.places[k]});
            double of_row = 0, slope_of_row = 0;
            for (std::size_t i = 0; i < 4; ++i) {
                const auto c = static_cast<double>(coefficients[row + static_cast<std::size_t>(x.places[i])]);
                of_row += x.weights[i] * c;
                slope_of_row += x.slopes[i] * c;
            }
            sum += glm::dvec4(z.weights[k] * y.weights[j] * slope_of_row, z.weights[k] * y.slopes[j] * of_row,
                              z.slopes[k] * y.weights[j] * of_row, z.weights[k] * y.weights[j] * of_row);
        }
    return sum;
}

double mean_of(const Volume& volume) {
    if (volume.packed) return volume.packed->mean();
    // Neumaier's sum: values that cancel leave exactly 0.
    double sum = 0, lost = 0;
    for (std::size_t i = 0; i < volume.values.size(); ++i) {
        if (!volume.has_data(i)) continue;
        const auto value = static_cast<double>(volume.values[i]);
        const double next = sum + value;
        lost += std::abs(sum) >= std::abs(value) ? (sum - next) + value : (value - next) + sum;
        sum = next;
    }
    return (sum + lost) / static_cast<double>(std::max<std::size_t>(volume.values.size() - volume.non_finite_count, 1));
}

namespace {

/// CRC-32 of number_of(0), number_of(1), ... as numbers of type T.
template <typename T, typename NumberOf>
std::uint32_t crc32_of(std::size_t count, const NumberOf& number_of) {
    constexpr std::size_t kPart = std::size_t{1} << 16;
    std::vector<T> part;
    uLong crc = crc32(0, nullptr, 0);
    for (std::size_t first = 0; first < count; first += kPart) {
        part.resize(std::min(kPart, count - first));
        for (std::size_t i = 0; i < part.size(); ++i)
            part[i] = number_of(first + i);
        crc = crc32(crc, reinterpret_cast<const Bytef*>(part.data()),  // NOLINT: zlib's interface
                    static_cast<uInt>(part.size() * sizeof(T)));
    }
    return static_cast<std::uint32_t>(crc);
}

}  // namespace

std::uint32_t samples_crc32(const Volume& volume) {
    static_assert(std::endian::native == std::endian::little);
    require_samples(volume, "the checksum of samples");
    const std::size_t count = volume.values.size();
    if (volume.labels && !volume.has_segmentation() && has_ranks(*volume.labels)) {
        const LabelTable& table = *volume.labels;
        return crc32_of<std::int64_t>(count, [&](std::size_t i) {
            if (!volume.has_data(i)) return std::numeric_limits<std::int64_t>::min();
            return static_cast<std::int64_t>(table.labels[place_of_label(table, volume.values[i])].id);
        });
    }
    return crc32_of<float>(count, [&](std::size_t i) {
        return static_cast<float>(volume.in_file_unit(static_cast<double>(volume.sample(i))));
    });
}

Histogram histogram(const Volume& volume, int bins) {
    if (bins < 1) fail("histogram: {} bins; at least 1 is needed", bins);
    Histogram result;
    result.low = static_cast<double>(volume.min_value);
    result.high = static_cast<double>(volume.max_value);
    result.counts.assign(static_cast<std::size_t>(bins), 0);
    const double range = result.high - result.low;
    const double scale = range > 0 ? bins / range : 0.0;
    if (volume.packed) {
        // The stored bins are finer. A bin that overlaps two is counted where its centre lies.
        const Histogram& stored = volume.packed->histogram();
        for (std::size_t bin = 0; bin < stored.counts.size(); ++bin)
            result.counts[(2 * bin + 1) * result.counts.size() / (2 * stored.counts.size())] += stored.counts[bin];
        return result;
    }
    for (std::size_t i = 0; i < volume.values.size(); ++i)
        if (volume.has_data(i)) ++result.counts[bin_of(volume.values[i], result.low, scale, result.counts.size())];
    return result;
}

}  // namespace edgesplat

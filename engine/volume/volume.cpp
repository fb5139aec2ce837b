#include "engine/volume/volume.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/error.h"
#include "engine/volume/checksum_internal.h"
#include "engine/volume/labels.h"

namespace edgesplat {
namespace {

void check_geometry(const Volume& volume) {
    const auto& dims = volume.geometry.dims;
    if (dims.x < 1 || dims.y < 1 || dims.z < 1)
        fail("{}: dims {} x {} x {}: each must be at least 1", volume.name, dims.x, dims.y, dims.z);
    if (volume.values.size() != volume.geometry.voxel_count())
        fail("{}: {} samples for dims {} x {} x {}", volume.name, volume.values.size(), dims.x, dims.y, dims.z);
    detail::check_axes(volume);
}

}  // namespace

std::string LabelTable::number_of(const Label& label) const {
    return is_signed ? fmt::format("{}", static_cast<std::int64_t>(label.id)) : fmt::format("{}", label.id);
}

namespace detail {

void VolumeChecksum::add(double value) {
    const auto bits = std::bit_cast<std::uint64_t>(value + 0.0);  // -0 and 0 are equal
    add(static_cast<std::uint32_t>(bits));
    add(static_cast<std::uint32_t>(bits >> 32));
}

VolumeChecksum::VolumeChecksum(const VolumeGeometry& geometry) {
    for (int axis = 0; axis < 3; ++axis)
        add(static_cast<std::uint32_t>(geometry.dims[axis]));
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            add(geometry.index_to_world_axes[column][row]);
    for (int axis = 0; axis < 3; ++axis)
        add(geometry.origin[axis]);
}

void VolumeChecksum::add(std::span<const float> samples, const LabelTable* ranks) {
    for (const float value : samples) {
        const auto bits = std::bit_cast<std::uint32_t>(value);
        if (ranks == nullptr || std::isnan(value)) {
            add(bits);
            continue;
        }
        const std::size_t place = place_of_label(*ranks, value);
        const std::uint64_t id = place < ranks->labels.size() ? ranks->labels[place].id : bits;
        add(static_cast<std::uint32_t>(id));
        add(static_cast<std::uint32_t>(id >> 32));
    }
}

void check_axes(const Volume& volume) {
    const auto& geometry = volume.geometry;
    for (int axis = 0; axis < 3; ++axis) {
        const auto column = geometry.index_to_world_axes[axis];
        const double length = glm::length(column);
        if (!std::isfinite(length) || !std::isfinite(geometry.origin[axis]))
            fail("{}: the spacing, direction or origin of axis {} is not finite", volume.name, axis);
        if (!(length > 0)) fail("{}: the spacing of axis {} is 0", volume.name, axis);
        // Outside this range, squared lengths overflow or underflow a float.
        if (length < 1e-9 || length > 1e9)
            fail("{}: the spacing of axis {} is {} mm, expected 1e-9 to 1e9; give --spacing in another unit",
                 volume.name, axis, length);
    }
    const auto spacing = geometry.spacing();
    const double volume_ratio =
        std::abs(glm::determinant(geometry.index_to_world_axes)) / (spacing.x * spacing.y * spacing.z);
    if (!(volume_ratio > 1e-6)) fail("{}: its three axes lie in one plane", volume.name);
}

}  // namespace detail

double noise_of(const Volume& volume) {
    const glm::ivec3 dims = volume.geometry.dims;
    if (volume.values.empty() || glm::any(glm::lessThan(dims, glm::ivec3(3)))) return 0;
    constexpr double kMostPlaces = 1 << 17;
    const double places = static_cast<double>(dims.x - 2) * (dims.y - 2) * (dims.z - 2);
    const int step = std::max(1, static_cast<int>(std::ceil(std::cbrt(places / kMostPlaces))));
    std::vector<double> differences;
    for (int z = 1; z + 1 < dims.z; z += step)
        for (int y = 1; y + 1 < dims.y; y += step)
            for (int x = 1; x + 1 < dims.x; x += step) {
                // The second difference along all three axes.
                double sum = 0;
                for (int k = 0; k < 27; ++k) {
                    const int a = k % 3 - 1, b = k / 3 % 3 - 1, c = k / 9 - 1;
                    const int weight = (a == 0 ? -2 : 1) * (b == 0 ? -2 : 1) * (c == 0 ? -2 : 1);
                    sum += weight * static_cast<double>(volume.at(x + a, y + b, z + c));
                }
                // Constant samples are clipped and say nothing.
                if (sum != 0) differences.push_back(std::abs(sum));
            }
    if (differences.empty()) return 0;
    const auto quartile = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 4);
    std::ranges::nth_element(differences, quartile);
    constexpr double kQuartile = 0.3186;  // of |x| for a normal deviate x
    return *quartile / (kQuartile * std::sqrt(216.0));
}

void finish_volume(Volume& volume) {
    check_geometry(volume);
    if (volume.no_data && volume.no_data->size() != volume.values.size())
        fail("{}: {} marks of missing data for {} samples", volume.name, volume.no_data->size(), volume.values.size());
    float low = std::numeric_limits<float>::infinity(), high = -low;
    std::size_t bad = 0;
    for (std::size_t i = 0; i < volume.values.size(); ++i) {
        const float value = volume.values[i];
        if (!std::isfinite(value) || !volume.has_data(i)) {
            ++bad;
            continue;
        }
        low = value < low ? value : low;
        high = value > high ? value : high;
    }
    volume.non_finite_count = bad;
    const bool any = bad < volume.values.size();
    volume.min_value = any ? low : 0.0F;
    volume.max_value = any ? high : 0.0F;
    if (volume.is_label_mask()) {
        volume.min_value = 0;
        volume.max_value = 1;
    }
    if (bad > 0) {
        auto no_data = std::make_shared<std::vector<bool>>(volume.values.size());
        for (std::size_t i = 0; i < volume.values.size(); ++i) {
            if (std::isfinite(volume.values[i]) && volume.has_data(i)) continue;
            (*no_data)[i] = true;
            volume.values[i] = volume.min_value;
        }
        volume.no_data = std::move(no_data);
    } else {
        volume.no_data.reset();
    }

    volume.noise = noise_of(volume);
    volume.two_values = !volume.values.empty() && std::ranges::all_of(volume.values, [&](float value) {
        return value == volume.min_value || value == volume.max_value;
    });
    detail::VolumeChecksum checksum(volume.geometry);
    const bool ranks = volume.labels && !volume.shown_labels && has_ranks(*volume.labels);
    checksum.add(volume.values, ranks ? volume.labels.get() : nullptr);
    if (volume.value_scale != 1) checksum.add_scale(volume.value_scale);
    // Which samples are missing changes the picture, too.
    for (std::size_t i = 0; bad > 0 && i < volume.values.size(); ++i)
        if (!volume.has_data(i)) checksum.add_missing(i);
    if (volume.shown_labels) checksum.add(volume.shown_labels->at);
    volume.checksum = checksum.value();
}

}  // namespace edgesplat

#include "engine/volume/io/samples.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <unordered_set>

#include "engine/error.h"
#include "engine/volume/labels.h"

namespace edgesplat::detail {
namespace {

/// Integers up to this magnitude are exact as floats.
constexpr std::uint64_t kExact = std::uint64_t{1} << 24;

template <typename T>
T stored_at(const StoredSamples& stored, std::size_t voxel) {
    std::array<unsigned char, sizeof(T)> raw{};
    std::memcpy(raw.data(), static_cast<const unsigned char*>(stored.data) + voxel * stored.stride * sizeof(T),
                sizeof(T));
    if (stored.swapped) std::reverse(raw.begin(), raw.end());
    T value;
    std::memcpy(&value, raw.data(), sizeof(T));
    return value;
}

/// Calls work with a value of the C++ type of the samples.
template <typename Work>
void for_type(SampleType type, const Work& work) {
    switch (type) {
        case SampleType::Int8:
            return work(std::int8_t{});
        case SampleType::UInt8:
            return work(std::uint8_t{});
        case SampleType::Int16:
            return work(std::int16_t{});
        case SampleType::UInt16:
            return work(std::uint16_t{});
        case SampleType::Int32:
            return work(std::int32_t{});
        case SampleType::UInt32:
            return work(std::uint32_t{});
        case SampleType::Int64:
            return work(std::int64_t{});
        case SampleType::UInt64:
            return work(std::uint64_t{});
        case SampleType::Float32:
            return work(float{});
        case SampleType::Float64:
            return work(double{});
    }
}

template <typename T>
std::uint64_t magnitude(T value) {
    if constexpr (std::is_signed_v<T>)
        return value < 0 ? ~static_cast<std::uint64_t>(value) + 1 : static_cast<std::uint64_t>(value);
    return static_cast<std::uint64_t>(value);
}

template <typename T>
bool is_fill(const StoredSamples& stored, T value) {
    return stored.fill && static_cast<double>(value) == *stored.fill;
}

/// Sets labels and ranks if some integers exceed `kExact` and there are few distinct ones. Returns whether it did.
template <typename T>
bool take_ranks(const StoredSamples& stored, Volume& volume) {
    const std::size_t count = volume.values.size();
    std::unordered_set<T> found;
    bool large = false;
    for (std::size_t i = 0; i < count; ++i) {
        const T value = stored_at<T>(stored, i);
        if (is_fill(stored, value)) continue;
        large = large || magnitude(value) > kExact;
        if (found.size() <= kMaxRankedLabels) found.insert(value);
    }
    if (!large || found.size() > kMaxRankedLabels) return false;
    std::vector<T> ids(found.begin(), found.end());
    std::sort(ids.begin(), ids.end());
    auto table = std::make_shared<LabelTable>();
    table->is_signed = std::is_signed_v<T>;
    for (std::size_t rank = 0; rank < ids.size(); ++rank)
        table->labels.push_back({.id = static_cast<std::uint64_t>(static_cast<std::int64_t>(ids[rank])),
                                 .value = static_cast<float>(rank),
                                 .name = {},
                                 .color = {}});
    for (std::size_t i = 0; i < count; ++i) {
        const T value = stored_at<T>(stored, i);
        const auto at = std::lower_bound(ids.begin(), ids.end(), value);
        volume.values[i] =
            is_fill(stored, value) ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(at - ids.begin());
    }
    volume.labels = std::move(table);
    return true;
}

constexpr double kLargest = 1e100;

/// How samples become floats.
struct FloatScale {
    double scale = 1;           ///< the power of two by which they are divided because floats cannot hold them
    std::size_t too_large = 0;  ///< those above kLargest are no measurements: they become infinite, without data
};

FloatScale scale_for(const StoredSamples& stored, std::size_t count) {
    constexpr double kHeld = 1e37, kSmallest = 1e-30;
    if (size_of(stored.type) < 8 && stored.slope == 1 && stored.intercept == 0) return {};
    double largest = 0;
    FloatScale found;
    for_type(stored.type, [&](auto example) {
        using T = decltype(example);
        for (std::size_t i = 0; i < count; ++i) {
            const auto value = static_cast<double>(stored_at<T>(stored, i));
            const double size = std::abs(stored.slope * value + stored.intercept);
            if (is_fill(stored, value)) continue;
            if (size <= kLargest)
                largest = std::max(largest, size);
            else if (std::isfinite(static_cast<double>(value)))
                ++found.too_large;
        }
    });
    const bool fits = largest <= kHeld && largest >= kSmallest;
    if (!fits && largest != 0) found.scale = std::ldexp(1.0, std::ilogb(largest));
    return found;
}

/// Whether an integer sample is not exact as a float.
bool loses_digits(const StoredSamples& stored, std::size_t count) {
    bool loses = false;
    for_type(stored.type, [&](auto example) {
        using T = decltype(example);
        if constexpr (std::is_integral_v<T> && sizeof(T) >= 4)
            for (std::size_t i = 0; i < count && !loses; ++i) {
                const T value = stored_at<T>(stored, i);
                loses = magnitude(value) > kExact && !is_fill(stored, value);
            }
    });
    return loses;
}

}  // namespace

void convert_stored(const StoredSamples& stored, std::size_t count, float* target) {
    const bool scaled = stored.slope != 1 || stored.intercept != 0;
    for_type(stored.type, [&](auto example) {
        using T = decltype(example);
        for (std::size_t i = 0; i < count; ++i) {
            const T value = stored_at<T>(stored, i);
            target[i] = scaled ? static_cast<float>(stored.slope * static_cast<double>(value) + stored.intercept)
                               : static_cast<float>(value);
            if (is_fill(stored, value)) target[i] = std::numeric_limits<float>::quiet_NaN();
        }
    });
}

bool needs_all(const StoredSamples& stored) {
    const bool large = size_of(stored.type) >= 4 && stored.type != SampleType::Float32;
    return large || stored.slope != 1 || stored.intercept != 0;
}

void take_samples(const StoredSamples& stored, Volume& volume) {
    const std::size_t count = volume.geometry.voxel_count();
    volume.values.resize(count);
    if (volume.stored_type.empty()) volume.stored_type = name_of(stored.type);
    const bool plain = stored.slope == 1 && stored.intercept == 0;
    if (plain && loses_digits(stored, count)) {
        bool ranked = false;
        for_type(stored.type, [&](auto example) {
            using T = decltype(example);
            if constexpr (std::is_integral_v<T> && sizeof(T) >= 4) ranked = take_ranks<T>(stored, volume);
        });
        if (ranked) return;
        volume.notes.emplace_back("Samples beyond 2^24 are rounded to 24 significant bits.");
    }
    const auto [scale, too_large] = scale_for(stored, count);
    if (too_large > 0)
        volume.warnings.push_back(
            fmt::format("{} samples are above {} in magnitude, which no measurement is: they contain no data.",
                        too_large, kLargest));
    StoredSamples scaled = stored;
    scaled.slope /= scale;
    scaled.intercept /= scale;
    volume.value_scale = scale;
    convert_stored(scaled, count, volume.values.data());
}

std::optional<double> millimetres_in(std::string_view unit) {
    std::string name;
    for (const char c : unit)
        if (std::isspace(static_cast<unsigned char>(c)) == 0 && c != '"')
            name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    // Plurals and both spellings of metre.
    if (name.size() > 3 && name.back() == 's') name.pop_back();
    if (name.ends_with("metre")) name.replace(name.size() - 2, 2, "er");
    struct Unit {
        std::string_view name;
        double millimetres;
    };
    constexpr double kInch = 25.4;
    static constexpr std::array kUnits{
        Unit{"mm", 1},           Unit{"millimeter", 1},   Unit{"cm", 10},         Unit{"centimeter", 10},
        Unit{"dm", 100},         Unit{"decimeter", 100},  Unit{"m", 1e3},         Unit{"meter", 1e3},
        Unit{"km", 1e6},         Unit{"kilometer", 1e6},  Unit{"um", 1e-3},       Unit{"\xc2\xb5m", 1e-3},
        Unit{"\xce\xbcm", 1e-3}, Unit{"\xb5m", 1e-3},     Unit{"micron", 1e-3},   Unit{"micrometer", 1e-3},
        Unit{"nm", 1e-6},        Unit{"nanometer", 1e-6}, Unit{"pm", 1e-9},       Unit{"picometer", 1e-9},
        Unit{"angstrom", 1e-7},  Unit{"\xc3\xa5", 1e-7},  Unit{"\xc3\x85", 1e-7}, Unit{"in", kInch},
        Unit{"inch", kInch},     Unit{"inche", kInch},    Unit{"\\u00b5m", 1e-3}, Unit{"ft", 12 * kInch},
        Unit{"foot", 12 * kInch}};
    for (const Unit& known : kUnits)
        if (known.name == name) return known.millimetres;
    return std::nullopt;
}

void set_place(Volume& volume, const glm::dmat3& axes, const glm::dvec3& origin, double millimetres,
               std::string_view source) {
    for (int axis = 0; axis < 3; ++axis)
        volume.geometry.index_to_world_axes[axis] = axes[axis] * millimetres + 0.0;  // + 0: no negative zeros
    volume.geometry.origin = origin * millimetres + 0.0;
    volume.geometry_source = source;
}

}  // namespace edgesplat::detail

#include "engine/volume/no_data.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_set>

#include "engine/error.h"
#include "engine/volume/value_text.h"

namespace edgesplat {
namespace {

constexpr std::size_t kFewestDistinct = 16;  ///< with fewer distinct values, all may be far apart
constexpr std::size_t kFewestSamples = 3;
constexpr double kKnownGap = 1, kUnknownGap = 100;  ///< distance, relative to the range of the others

/// Numbers that programs write where they have no data.
bool is_usual_fill(float value) {
    constexpr std::array<float, 12> kUsual{99,    999,   9999,  99999,         999999,        32767,
                                           32768, 65535, 65536, 2147483648.0F, 4294967296.0F, 999.25F};
    const float size = std::abs(value);
    return size >= 1e19F || std::ranges::find(kUsual, size) != kUsual.end();
}

/// Distinct values at one end of the range, from the outside in, each with its count.
struct Outermost {
    std::array<float, 2> values{};
    std::array<std::size_t, 2> counts{};
    int known = 0;

    template <typename Before>
    void add(float value, const Before& before) {
        int place = 0;
        while (place < known && before(values[static_cast<std::size_t>(place)], value))
            ++place;
        if (place == 2) return;
        const auto at = static_cast<std::size_t>(place);
        if (place < known && values[at] == value) {
            ++counts[at];
            return;
        }
        if (at == 0) {
            values[1] = values[0];
            counts[1] = counts[0];
        }
        values[at] = value;
        counts[at] = 1;
        known = std::min(known + 1, 2);
    }
};

bool is_far(float value, std::size_t count, float next, double range) {
    if (count < kFewestSamples || value == 0 || !(range > 0)) return false;
    const double gap = std::abs(static_cast<double>(value) - static_cast<double>(next));
    return gap >= (is_usual_fill(value) ? kKnownGap : kUnknownGap) * range;
}

}  // namespace

std::size_t declare_no_data(Volume& volume, double value) {
    if (volume.values.empty()) fail("{}: samples without data cannot be declared in a packed volume", volume.name);
    float sample = static_cast<float>(value / volume.value_scale);
    if (volume.labels) {
        const auto& labels = volume.labels->labels;
        const auto found = std::ranges::find_if(labels, [&](const Label& label) {
            return (volume.labels->is_signed ? static_cast<double>(static_cast<std::int64_t>(label.id))
                                             : static_cast<double>(label.id)) == value;
        });
        if (found == labels.end()) return 0;
        sample = found->value;
    }
    if (!volume.labels && std::ranges::find(volume.values, sample) == volume.values.end()) {
        // The only value that the number may be a rounding of.
        constexpr float kRounding = 1e-3F;
        float nearby = std::numeric_limits<float>::quiet_NaN();
        for (const float other : volume.values) {
            if (!(std::abs(other - sample) <= kRounding * std::abs(sample)) || other == nearby) continue;
            if (!std::isnan(nearby)) return 0;
            nearby = other;
        }
        sample = nearby;
    }
    std::size_t count = 0;
    for (float& other : volume.values) {
        if (other != sample) continue;
        other = std::numeric_limits<float>::quiet_NaN();
        ++count;
    }
    return count;
}

std::vector<SuspectedFill> suspected_fill(const Volume& volume) {
    Outermost low, high;
    std::unordered_set<float> distinct;
    for (std::size_t i = 0; i < volume.values.size(); ++i) {
        if (!volume.has_data(i)) continue;
        const float value = volume.values[i];
        if (distinct.size() < kFewestDistinct) distinct.insert(value);
        if (low.known < 2 || value <= low.values[1]) low.add(value, std::less<>());
        if (high.known < 2 || value >= high.values[1]) high.add(value, std::greater<>());
    }
    if (distinct.size() < kFewestDistinct) return {};
    const auto [low_fill, low_next] = low.values;
    const auto [high_fill, high_next] = high.values;
    const auto range = [](float from, float to) { return static_cast<double>(to) - static_cast<double>(from); };
    const SuspectedFill below{low_fill, low.counts[0], low_next, high_next};
    const SuspectedFill above{high_fill, high.counts[0], low_next, high_next};
    const double inner = range(low_next, high_next);
    if (is_far(low_fill, low.counts[0], low_next, inner) && is_far(high_fill, high.counts[0], high_next, inner))
        return {below, above};
    if (is_far(low_fill, low.counts[0], low_next, range(low_next, high_fill)))
        return {{low_fill, low.counts[0], low_next, high_fill}};
    if (is_far(high_fill, high.counts[0], high_next, range(low_fill, high_next)))
        return {{high_fill, high.counts[0], low_fill, high_next}};
    return {};
}

std::string text_of(const SuspectedFill& fill, const Volume& volume) {
    const std::string value = value_text(volume, fill.value);
    return fmt::format("{} samples are {}, far from the rest ({} to {}). If they contain no data, give --no-data {}.",
                       fill.count, value, value_text(volume, fill.low), value_text(volume, fill.high), value);
}

}  // namespace edgesplat

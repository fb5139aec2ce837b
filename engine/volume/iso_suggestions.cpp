// Suggests iso-values: surfaces that are strong, smooth and visible from outside.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "engine/volume/filters.h"
#include "engine/volume/packed_internal.h"

namespace edgesplat {
namespace {

using detail::bin_of;

constexpr std::size_t kBins = 256;  ///< number of candidate values, evenly spaced from the smallest to the largest
constexpr int kMostRays = 256;      ///< rays along each side of a face of the volume
/// Weight of smoothness: noise has gradients as strong as a surface, but random normals.
constexpr int kSmoothnessPower = 6;

// For few distinct values (masks, label volumes): surfaces lie halfway between neighbouring values.
std::vector<IsoSuggestion> between_values(const std::vector<std::size_t>& counts, double low, double width) {
    std::vector<IsoSuggestion> result;
    std::size_t last = counts.size();
    for (std::size_t bin = 0; bin < counts.size(); ++bin) {
        if (counts[bin] == 0) continue;
        if (last < counts.size()) {
            const double middle = (static_cast<double>(last) + static_cast<double>(bin) + 1) / 2;
            result.push_back({low + middle * width, 1.0 / static_cast<double>(result.size() + 1)});
        }
        last = bin;
    }
    return result;
}

/// Accesses the samples of a volume along its axes.
class Walker {
  public:
    explicit Walker(const Volume& volume)
        : volume_(volume),
          strides_{1, volume.geometry.dims.x,
                   static_cast<std::ptrdiff_t>(volume.geometry.dims.x) * volume.geometry.dims.y},
          per_range_(1 / (static_cast<double>(volume.max_value) - static_cast<double>(volume.min_value))),
          spacing_(volume.geometry.spacing()) {}

    const float* at(const glm::ivec3& voxel) const {
        return volume_.values.data() + voxel.z * strides_[2] + voxel.y * strides_[1] + voxel.x;
    }
    std::ptrdiff_t stride(int axis) const { return strides_.at(static_cast<std::size_t>(axis)); }

    bool has_data(const float* sample) const {
        return volume_.has_data(static_cast<std::size_t>(sample - volume_.values.data()));
    }

    /// Gradient by central differences, one-sided at the border and beside missing samples; shares of the range per
    /// mm along the volume's axes.
    glm::dvec3 gradient(const glm::ivec3& voxel) const {
        const float* here = at(voxel);
        glm::dvec3 g(0);
        for (int axis = 0; axis < 3; ++axis) {
            std::ptrdiff_t up = voxel[axis] + 1 < volume_.geometry.dims[axis] ? stride(axis) : 0;
            std::ptrdiff_t down = voxel[axis] > 0 ? stride(axis) : 0;
            if (!has_data(here + up)) up = 0;
            if (!has_data(here - down)) down = 0;
            const double steps = (up > 0) + (down > 0);
            const double rise = static_cast<double>(here[up]) - static_cast<double>(here[-down]);
            if (steps > 0) g[axis] = rise * per_range_ / (steps * spacing_[axis]);
        }
        return g;
    }

  private:
    const Volume& volume_;
    std::array<std::ptrdiff_t, 3> strides_;
    double per_range_;
    glm::dvec3 spacing_;
};

/// Detects padding around a measured cylinder. Criteria: many voxels have the smallest value, no voxels have values
/// just above it, and it borders on one common value only (air).
bool has_padding(const Volume& volume, const Walker& walker) {
    constexpr double kFewest = 0.01, kMeasured = 0.3, kGap = 0.02, kAlike = 0.1, kCommon = 0.2;
    const float pad = volume.min_value, high = volume.max_value;
    float next = high;
    std::size_t count = 0;
    for (std::size_t i = 0; i < volume.values.size(); ++i) {
        if (!volume.has_data(i)) continue;
        const float value = volume.values[i];
        if (value == pad)
            ++count;
        else
            next = std::min(next, value);
    }
    const auto all = static_cast<double>(volume.values.size() - volume.non_finite_count);
    const auto padded = static_cast<double>(count);
    if (padded < kFewest * all || padded > (1 - kMeasured) * all ||
        next - pad < static_cast<float>(kGap) * (high - pad))
        return false;
    std::vector<float> beside;
    const glm::ivec3 dims = volume.geometry.dims;
    for (int z = 0; z < dims.z; ++z)
        for (int y = 0; y < dims.y; ++y) {
            const float* line = walker.at({0, y, z});
            for (int x = 0; x + 1 < dims.x; ++x)
                if ((line[x] == pad) != (line[x + 1] == pad) && walker.has_data(line + x) &&
                    walker.has_data(line + x + 1))
                    beside.push_back(std::max(line[x], line[x + 1]));
        }
    if (beside.empty()) return false;
    std::ranges::sort(beside);
    const float least = beside[beside.size() / 20], most = beside[beside.size() - 1 - beside.size() / 20];
    const auto alike = std::ranges::count_if(volume.values, [&](float v) { return v >= least && v <= most; });
    return most - least <= static_cast<float>(kAlike) * (high - next) &&
           static_cast<double>(alike) >= kCommon * (all - padded);
}

/// Statistics of the first surfaces that rays meet from outside, per candidate value.
struct FirstSurfaces {
    std::array<double, kBins + 1> count{}, strength{}, smoothness{};  ///< first differences, then prefix sums
    double rays = 0;
};

/// Follows one ray. At each sample above all earlier ones, the ray first meets the values in between.
void follow(const Volume& volume, const Walker& walker, glm::ivec3 voxel, int axis, int direction,
            std::optional<float> padding, FirstSurfaces& out) {
    const float low = volume.min_value;
    const double per_bin =
        static_cast<double>(kBins) / (static_cast<double>(volume.max_value) - static_cast<double>(low));
    const auto bin = [&](float value) {
        return static_cast<std::size_t>((static_cast<double>(value) - static_cast<double>(low)) * per_bin + 0.5);
    };
    const int length = volume.geometry.dims[axis];
    const std::ptrdiff_t stride = walker.stride(axis) * direction;
    const float* sample = walker.at(voxel);
    bool begun = walker.has_data(sample);  // whether the ray has met data
    float before = *sample;
    for (int i = 1; i < length && before < volume.max_value; ++i) {
        sample += stride;
        voxel[axis] += direction;
        if (!walker.has_data(sample)) continue;
        const bool first_data = !begun;
        begun = true;
        if (*sample <= before && !first_data) continue;
        const float from = before;
        before = *sample;
        // The end of the data is no surface.
        if (first_data || !walker.has_data(sample - stride)) continue;
        if (padding && from == *padding) continue;
        // Value i is the centre of bin i.
        const std::size_t first = bin(from), last = bin(before);
        if (first == last) continue;
        glm::ivec3 behind = voxel;
        behind[axis] -= direction;
        const glm::dvec3 a = walker.gradient(behind), b = walker.gradient(voxel);
        const double length_a = glm::length(a), length_b = glm::length(b);
        const double both = length_a * length_b;
        const double smooth = both > 0 ? std::max(0.0, glm::dot(a, b) / both) : 0;
        for (const auto& [sums, value] :
             {std::pair{&out.count, 1.0}, {&out.strength, (length_a + length_b) / 2}, {&out.smoothness, smooth}}) {
            (*sums)[first] += value;
            (*sums)[last] -= value;
        }
    }
    ++out.rays;
}

FirstSurfaces first_surfaces(const Volume& volume) {
    const Walker walker(volume);
    const std::optional<float> padding = has_padding(volume, walker) ? std::optional(volume.min_value) : std::nullopt;
    FirstSurfaces out;
    const glm::ivec3 dims = volume.geometry.dims;
    for (int axis = 0; axis < 3; ++axis) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        const int step_u = (dims[u] + kMostRays - 1) / kMostRays, step_v = (dims[v] + kMostRays - 1) / kMostRays;
        for (const int direction : {1, -1})
            for (int j = 0; j < dims[v]; j += step_v)
                for (int i = 0; i < dims[u]; i += step_u) {
                    glm::ivec3 voxel(0);
                    voxel[axis] = direction > 0 ? 0 : dims[axis] - 1;
                    voxel[u] = i;
                    voxel[v] = j;
                    follow(volume, walker, voxel, axis, direction, padding, out);
                }
    }
    for (auto* sums : {&out.count, &out.strength, &out.smoothness})
        for (std::size_t bin = 1; bin < kBins; ++bin)
            (*sums)[bin] += (*sums)[bin - 1];
    return out;
}

/// Score: share of the rays that meet a surface, times its mean gradient, times a power of its smoothness.
std::array<double, kBins> scores(const FirstSurfaces& found) {
    std::array<double, kBins> result{};
    for (std::size_t bin = 0; bin < kBins; ++bin) {
        const double count = found.count[bin];
        // Ignores surfaces of a few voxels.
        if (count < 0.002 * found.rays || count < 4) continue;
        result[bin] = found.strength[bin] / found.rays * std::pow(found.smoothness[bin] / count, kSmoothnessPower);
    }
    return result;
}

std::vector<IsoSuggestion> peaks(const std::array<double, kBins>& score, double low, double width) {
    constexpr std::ptrdiff_t kApart = 10;
    constexpr double kWeakest = 0.01;  // relative to the strongest
    const auto at = [&](std::ptrdiff_t bin) { return score[static_cast<std::size_t>(bin)]; };
    std::vector<IsoSuggestion> result;
    for (std::ptrdiff_t bin = 0; bin < std::ptrdiff_t{kBins}; ++bin) {
        const double here = at(bin);
        // All values in a gap between samples have the same surface: the middle of the gap represents them.
        const double alike = here * (1 - 1e-9);
        std::ptrdiff_t last = bin;
        while (last + 1 < std::ptrdiff_t{kBins} && at(last + 1) >= alike && at(last + 1) <= here)
            ++last;
        bool peak = here > 0;
        for (auto i = std::max<std::ptrdiff_t>(0, bin - kApart);
             peak && i <= std::min<std::ptrdiff_t>(kBins - 1, last + kApart); ++i)
            peak = i < bin ? at(i) < alike : at(i) <= here;
        if (!peak) continue;
        result.push_back({low + (static_cast<double>(bin + last) / 2 + 0.5) * width, here});
        bin = last;
    }
    std::ranges::sort(result, std::ranges::greater(), &IsoSuggestion::strength);
    const double strongest = result.empty() ? 1 : result.front().strength;
    std::erase_if(result, [&](const auto& suggestion) { return suggestion.strength < kWeakest * strongest; });
    for (auto& suggestion : result)
        suggestion.strength /= strongest;
    return result;
}

}  // namespace

std::vector<IsoSuggestion> suggest_iso_values(const Volume& volume, int count) {
    if (volume.packed)
        return suggest_iso_values(load_level(volume, finest_level_within(*volume.packed, kMaxVoxelsAnalysed)), count);
    const double low = static_cast<double>(volume.min_value), range = static_cast<double>(volume.max_value) - low;
    if (!(range > 0) || count < 1) return {};
    std::vector<std::size_t> counts(kBins, 0);
    for (std::size_t i = 0; i < volume.values.size(); ++i)
        if (volume.has_data(i)) ++counts[bin_of(volume.values[i], low, kBins / range, kBins)];
    const auto occupied = std::ranges::count_if(counts, [](std::size_t n) { return n > 0; });
    std::vector<IsoSuggestion> result;
    if (occupied > 40) result = peaks(scores(first_surfaces(volume)), low, range / kBins);
    // Few values, or no surface visible from outside.
    if (result.empty()) result = between_values(counts, low, range / kBins);
    if (result.size() > static_cast<std::size_t>(count)) result.resize(static_cast<std::size_t>(count));
    return result;
}

}  // namespace edgesplat

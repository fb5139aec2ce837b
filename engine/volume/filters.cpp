#include "engine/volume/filters.h"

#include <itkBSplineDecompositionImageFilter.h>
#include <itkImage.h>

#include <algorithm>
#include <cmath>

#include "engine/error.h"
#include "engine/volume/packed_internal.h"

namespace edgesplat {
namespace {

Volume like(const Volume& volume) {
    Volume result;
    result.geometry = volume.geometry;
    result.in_patient = volume.in_patient;
    result.name = volume.name;
    result.stored_type = volume.stored_type;
    result.notes = volume.notes;
    result.values.resize(volume.values.size());
    return result;
}

using detail::bin_of;

// Gradient magnitude per mm summed over the voxels of each value bin, and how many they were. Axes of one voxel and
// oblique axes are fine: the differences are taken per voxel and divided by the length of the step.
struct GradientByValue {
    std::vector<double> sum;
    std::vector<std::size_t> count;
};

GradientByValue gradients_by_value(const Volume& volume, std::size_t bins) {
    const auto& dims = volume.geometry.dims;
    const auto spacing = volume.geometry.spacing();
    const double low = static_cast<double>(volume.min_value), range = static_cast<double>(volume.max_value) - low;
    const double scale = static_cast<double>(bins) / range;
    GradientByValue result{std::vector<double>(bins, 0.0), std::vector<std::size_t>(bins, 0)};
    const auto row = static_cast<std::ptrdiff_t>(dims.x), slice = row * dims.y;
    for (int z = 0; z < dims.z; ++z)
        for (int y = 0; y < dims.y; ++y) {
            const float* line = volume.values.data() + z * slice + y * row;
            const std::ptrdiff_t up = y + 1 < dims.y ? row : 0, down = y > 0 ? row : 0;
            const std::ptrdiff_t far = z + 1 < dims.z ? slice : 0, near = z > 0 ? slice : 0;
            const float by_y =
                up + down > 0
                    ? static_cast<float>(static_cast<double>(row) / static_cast<double>(up + down) / spacing.y)
                    : 0.0F;
            const float by_z =
                far + near > 0
                    ? static_cast<float>(static_cast<double>(slice) / static_cast<double>(far + near) / spacing.z)
                    : 0.0F;
            for (int x = 0; x < dims.x; ++x) {
                const int right = x + 1 < dims.x ? 1 : 0, left = x > 0 ? 1 : 0;
                const float by_x = right + left > 0 ? static_cast<float>(1.0 / (right + left) / spacing.x) : 0.0F;
                const float* here = line + x;
                const float gx = (here[right] - here[-left]) * by_x;
                const float gy = (here[up] - here[-down]) * by_y;
                const float gz = (here[far] - here[-near]) * by_z;
                const auto bin = bin_of(*here, low, scale, bins);
                result.sum[bin] += static_cast<double>(std::sqrt(gx * gx + gy * gy + gz * gz));
                ++result.count[bin];
            }
        }
    return result;
}

// Few distinct values: masks and label volumes. Their surfaces lie halfway between neighbouring values.
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

}  // namespace

Volume box_filter(const Volume& volume) {
    need_samples(volume, "the box filter");
    const auto& dims = volume.geometry.dims;
    Volume result = like(volume);
    const auto row = static_cast<std::ptrdiff_t>(dims.x), slice = row * dims.y;
    for (int z = 0; z < dims.z; ++z)
        for (int y = 0; y < dims.y; ++y)
            for (int x = 0; x < dims.x; ++x) {
                double sum = 0;
                for (int dz = -1; dz <= 1; ++dz)
                    for (int dy = -1; dy <= 1; ++dy)
                        for (int dx = -1; dx <= 1; ++dx)
                            sum += static_cast<double>(volume.at(std::clamp(x + dx, 0, dims.x - 1),
                                                                 std::clamp(y + dy, 0, dims.y - 1),
                                                                 std::clamp(z + dz, 0, dims.z - 1)));
                result.values[static_cast<std::size_t>(z * slice + y * row + x)] = static_cast<float>(sum / 27);
            }
    finish_volume(result);
    return result;
}

Volume threshold(const Volume& volume, double iso_value) {
    need_samples(volume, "the threshold");
    Volume result = like(volume);
    std::transform(volume.values.begin(), volume.values.end(), result.values.begin(),
                   [&](float value) { return static_cast<double>(value) >= iso_value ? 1.0F : 0.0F; });
    finish_volume(result);
    return result;
}

double scaled_value(const Volume& volume, double value) {
    const double low = static_cast<double>(volume.min_value), range = static_cast<double>(volume.max_value) - low;
    return range > 0 ? (value - low) / range : 0.0;
}

double scaled_iso_value(const Volume& volume, double iso_value) {
    constexpr double kOutsideTheData = 1e9;
    if (iso_value <= static_cast<double>(volume.min_value)) return -kOutsideTheData;
    if (iso_value > static_cast<double>(volume.max_value)) return kOutsideTheData;
    return scaled_value(volume, iso_value);
}

Volume cropped(const Volume& volume, const glm::ivec3& low, const glm::ivec3& high) {
    need_samples(volume, "cropping");
    const glm::ivec3 dims = volume.geometry.dims;
    if (glm::any(glm::lessThan(low, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(high, dims)) ||
        glm::any(glm::lessThan(high - low, glm::ivec3(1))))
        fail("crop {},{},{} to {},{},{}: expected at least 2 voxels along each axis within {} x {} x {}", low.x, low.y,
             low.z, high.x, high.y, high.z, dims.x, dims.y, dims.z);
    Volume result = volume;
    result.geometry.dims = high - low + 1;
    result.geometry.origin = volume.geometry.to_world(glm::dvec3(low));
    result.values.clear();
    for (int z = low.z; z <= high.z; ++z)
        for (int y = low.y; y <= high.y; ++y)
            for (int x = low.x; x <= high.x; ++x)
                result.values.push_back(volume.at(x, y, z));
    finish_volume(result);
    return result;
}

std::vector<float> scaled_field(const Volume& volume) {
    need_samples(volume, "the scaled field");
    std::vector<float> field(volume.values.size());
    std::transform(volume.values.begin(), volume.values.end(), field.begin(),
                   [&](float value) { return static_cast<float>(scaled_value(volume, static_cast<double>(value))); });
    return field;
}

std::vector<float> scaled_box(const Volume& volume, const VoxelBox& box) {
    need_samples(volume, "the scaled field");
    std::vector<float> field;
    field.reserve(box.count());
    for (int z = box.low.z; z <= box.high.z; ++z)
        for (int y = box.low.y; y <= box.high.y; ++y)
            for (int x = box.low.x; x <= box.high.x; ++x)
                field.push_back(static_cast<float>(scaled_value(volume, static_cast<double>(volume.at(x, y, z)))));
    return field;
}

std::vector<float> bspline_coefficients(const std::vector<float>& field, const glm::ivec3& dims) {
    using ImageType = itk::Image<float, 3>;
    if (dims.x < 1 || dims.y < 1 || dims.z < 1 ||
        field.size() !=
            static_cast<std::size_t>(dims.x) * static_cast<std::size_t>(dims.y) * static_cast<std::size_t>(dims.z))
        fail("B-spline coefficients: {} samples for dims {} x {} x {}", field.size(), dims.x, dims.y, dims.z);
    const auto image = ImageType::New();
    const ImageType::SizeType size{{static_cast<itk::SizeValueType>(dims.x), static_cast<itk::SizeValueType>(dims.y),
                                    static_cast<itk::SizeValueType>(dims.z)}};
    image->SetRegions(size);
    auto samples = field;  // ITK's image points at them: no second copy
    image->GetPixelContainer()->SetImportPointer(samples.data(), samples.size(), false);
    const auto filter = itk::BSplineDecompositionImageFilter<ImageType, ImageType>::New();
    filter->SetSplineOrder(3);
    filter->SetInput(image);
    try {
        filter->Update();
    } catch (const itk::ExceptionObject& error) {
        fail("B-spline coefficients: {}", error.GetDescription());
    }
    const float* coefficients = filter->GetOutput()->GetBufferPointer();
    std::copy_n(coefficients, samples.size(), samples.begin());
    return samples;
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
        // Its own bins are finer. Where they do not fit into these, one goes where its middle lies.
        const Histogram& stored = volume.packed->histogram();
        for (std::size_t bin = 0; bin < stored.counts.size(); ++bin)
            result.counts[(2 * bin + 1) * result.counts.size() / (2 * stored.counts.size())] += stored.counts[bin];
        return result;
    }
    for (const float value : volume.values)
        ++result.counts[bin_of(value, result.low, scale, result.counts.size())];
    return result;
}

std::vector<IsoSuggestion> suggest_iso_values(const Volume& volume, int count) {
    if (volume.packed)
        return suggest_iso_values(load_level(volume, finest_level_within(*volume.packed, kMaxVoxelsLookedAt)), count);
    const double low = static_cast<double>(volume.min_value), range = static_cast<double>(volume.max_value) - low;
    if (!(range > 0) || count < 1) return {};
    constexpr std::size_t kBins = 256;
    const double width = range / kBins;
    const auto gradients = gradients_by_value(volume, kBins);
    const auto occupied =
        std::count_if(gradients.count.begin(), gradients.count.end(), [](std::size_t n) { return n > 0; });
    std::vector<IsoSuggestion> result;
    if (occupied <= 40) {
        result = between_values(gradients.count, low, width);
    } else {
        // Mean over a window of 9 bins, so that a handful of odd voxels makes no peak.
        constexpr std::ptrdiff_t kHalfWindow = 4;
        std::vector<double> mean(kBins, 0.0);
        const auto enough = std::max<std::size_t>(16, volume.values.size() / 20000);
        for (std::ptrdiff_t bin = 0; bin < std::ptrdiff_t{kBins}; ++bin) {
            double sum = 0;
            std::size_t n = 0;
            for (auto i = std::max<std::ptrdiff_t>(0, bin - kHalfWindow);
                 i <= std::min<std::ptrdiff_t>(kBins - 1, bin + kHalfWindow); ++i) {
                sum += gradients.sum[static_cast<std::size_t>(i)];
                n += gradients.count[static_cast<std::size_t>(i)];
            }
            if (n >= enough) mean[static_cast<std::size_t>(bin)] = sum / static_cast<double>(n);
        }
        constexpr std::ptrdiff_t kApart = 10;
        for (std::ptrdiff_t bin = 1; bin + 1 < std::ptrdiff_t{kBins}; ++bin) {
            const double here = mean[static_cast<std::size_t>(bin)];
            bool peak = here > 0;
            for (auto i = std::max<std::ptrdiff_t>(0, bin - kApart);
                 peak && i <= std::min<std::ptrdiff_t>(kBins - 1, bin + kApart); ++i) {
                const double other = mean[static_cast<std::size_t>(i)];
                peak = i < bin ? other < here : other <= here;
            }
            // Rare bright voxels have the steepest gradients, noise in air has the most voxels: the mean times the root
            // of the count lets neither win.
            if (peak) {
                const double voxels = static_cast<double>(gradients.count[static_cast<std::size_t>(bin)]);
                result.push_back({low + (static_cast<double>(bin) + 0.5) * width, here * std::sqrt(voxels)});
            }
        }
        std::sort(result.begin(), result.end(), [](const auto& a, const auto& b) { return a.strength > b.strength; });
        const double strongest = result.empty() ? 1 : result.front().strength;
        std::erase_if(result, [&](const auto& suggestion) { return !(suggestion.strength > 1e-3 * strongest); });
        for (auto& suggestion : result)
            suggestion.strength /= strongest;
    }
    if (result.size() > static_cast<std::size_t>(count)) result.resize(static_cast<std::size_t>(count));
    return result;
}

}  // namespace edgesplat

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

}  // namespace edgesplat

#include "engine/reference/interpolated_scene.h"

#include <algorithm>
#include <limits>
#include <memory>

#include "engine/reference/field.h"
#include "engine/scene/transfer_function.h"
#include "engine/volume/filters.h"

namespace edgesplat::reference {

namespace {

/// T(p) of the samples with data around p; 0 if there are none.
double sample_of_data(const Field& field, const glm::dvec3& p) {
    const glm::ivec3 cell(p);
    const glm::dvec3 t = p - glm::dvec3(cell);
    double sum = 0, weights = 0;
    for (int k = 0; k < 8; ++k) {
        const glm::ivec3 step(k & 1, (k >> 1) & 1, (k >> 2) & 1);
        const std::size_t at = field.offset(field.clamped(cell + step));
        if (!field.has_data(at)) continue;
        const glm::dvec3 w = glm::mix(1.0 - t, t, glm::dvec3(step));
        sum += w.x * w.y * w.z * static_cast<double>(field.values[at]);
        weights += w.x * w.y * w.z;
    }
    return weights > 0 ? sum / weights : 0;
}

}  // namespace

AnalyticScene interpolated_scene(const Volume& volume, RaycastFilter filter, const Scene& look) {
    struct Samples {
        std::vector<float> values, coefficients;
    };
    const bool cubic = filter == RaycastFilter::Cubic;
    const auto samples = std::make_shared<Samples>();
    samples->values = scaled_field(volume);
    if (cubic) samples->coefficients = bspline_coefficients(samples->values, volume.geometry.dims);
    const auto field = [samples, dims = volume.geometry.dims] {
        return Field{dims, samples->values, samples->coefficients};
    };
    const auto low = static_cast<double>(volume.min_value), range = static_cast<double>(volume.max_value) - low;
    const auto inside = [dims = glm::dvec3(volume.geometry.dims - 1)](const glm::dvec3& x) {
        return glm::clamp(x, glm::min(glm::dvec3(1), dims / 2.0), glm::max(dims - 1.0, dims / 2.0));
    };
    AnalyticScene scene;
    scene.name = volume.name;
    scene.dims = volume.geometry.dims;
    scene.iso_values = {low + range / 2};
    // Beyond the outermost samples the trilinear field is constant along each axis; the spline continues linearly.
    const auto held = [last = glm::dvec3(volume.geometry.dims - 1)](const glm::dvec3& x) {
        return glm::clamp(x, glm::dvec3(0), last);
    };
    const bool missing = draws_missing_samples(look, volume), of_data = missing && !look.transfer.empty();
    scene.value = [=](const glm::dvec3& x) {
        return low + range * (of_data ? sample_of_data(field(), held(x)) : sample(field(), cubic ? x : held(x), cubic));
    };
    if (missing) {
        // Matter of the smallest value ends at the first iso-value above it.
        double end = std::numeric_limits<double>::infinity();
        for (const double iso : look.iso_values)
            if (scaled_iso_value(volume, iso) > 0) end = std::min(end, scaled_iso_value(volume, iso));
        scene.without_data = [=](const glm::dvec3& x) {
            const Field f = field();
            return !f.has_data(f.offset(f.clamped(glm::ivec3(glm::round(held(x)))))) &&
                   (of_data || sample(f, cubic ? x : held(x), cubic) < end);
        };
    }
    scene.gradient = [=](const glm::dvec3& x) {
        if (cubic) return range * spline_gradient(field(), x);
        const glm::dvec3 p = inside(x);
        glm::dvec3 slope(0);
        for (int axis = 0; axis < 3; ++axis) {
            glm::dvec3 step(0);
            step[axis] = 1;
            slope[axis] = range * (sample(field(), p + step) - sample(field(), p - step)) / 2;
        }
        return slope;
    };
    return scene;
}

}  // namespace edgesplat::reference

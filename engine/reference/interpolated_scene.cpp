#include "engine/reference/interpolated_scene.h"

#include <memory>

#include "engine/reference/field.h"
#include "engine/volume/filters.h"

namespace edgesplat::reference {

AnalyticScene interpolated_scene(const Volume& volume, RaycastFilter filter) {
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
    // Beyond the outermost samples the field is constant along each axis.
    const auto held = [last = glm::dvec3(volume.geometry.dims - 1)](const glm::dvec3& x) {
        return glm::clamp(x, glm::dvec3(0), last);
    };
    scene.value = [=](const glm::dvec3& x) { return low + range * sample(field(), held(x), cubic); };
    scene.gradient = [=](const glm::dvec3& x) {
        const glm::dvec3 p = inside(x);
        if (cubic) return range * spline_gradient(field(), p);
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

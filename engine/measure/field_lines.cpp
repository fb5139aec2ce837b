#include "engine/measure/field_lines.h"

#include <algorithm>
#include <cmath>

#include "engine/volume/filters.h"

namespace edgesplat::measure {
namespace {

constexpr int kHalvings = 40;

/// Indices and weights of samples or spline coefficients around a position on an axis; `count` of the four are used.
struct Taps {
    SplineTaps beside;
    std::size_t count = 4;
};

Taps taps(double place, int size, bool cubic) {
    const double p = std::clamp(place, 0.0, static_cast<double>(size - 1));
    if (cubic) return {spline_taps(p, size)};
    const int cell = static_cast<int>(p);
    const double t = p - cell;
    return {{.weights = {1 - t, t}, .slopes = {}, .places = {cell, std::min(cell + 1, size - 1)}}, 2};
}

/// The spline's value at the second of three coefficients.
double at_knot(const double* v) {
    return (v[0] + 4 * v[1] + v[2]) / 6;
}

/// The spline in a cell, t in [0, 1], from the four coefficients around it.
struct Cubic {
    double a, b, c, d;  ///< a + b t + c t^2 + d t^3
    explicit Cubic(const double* v)
        : a(at_knot(v)),
          b((v[2] - v[0]) / 2),
          c((v[0] - 2 * v[1] + v[2]) / 2),
          d((v[3] - v[0] + 3 * (v[1] - v[2])) / 6) {}
    double operator()(double t) const { return a + t * (b + t * (c + t * d)); }
    /// Ends of the monotonic pieces: 0, interior extrema, 1.
    int monotonous(std::array<double, 4>& ends) const {
        int count = 0;
        ends[count++] = 0;
        const double square = c * c - 3 * d * b;
        if (square > 0) {
            const double q = -(c + std::copysign(std::sqrt(square), c));
            std::array<double, 2> roots{d != 0 ? q / (3 * d) : -1, q != 0 ? b / q : -1};
            if (roots[0] > roots[1]) std::swap(roots[0], roots[1]);
            for (const double root : roots)
                if (root > 0 && root < 1) ends[count++] = root;
        }
        ends[count++] = 1;
        return count;
    }
};

}  // namespace

FieldLine::FieldLine(const reference::Field& field, int axis)
    : field_(field), axis_(axis), cubic_(!field.coefficients.empty()) {
    nodes_.resize(static_cast<std::size_t>(field.dims[axis]) + (cubic_ ? 2 : 0));
}

void FieldLine::move_to(const glm::dvec3& across) {
    across_ = across;
    const int b = (axis_ + 1) % 3, c = (axis_ + 2) % 3;
    const Taps tb = taps(across[b], field_.dims[b], cubic_), tc = taps(across[c], field_.dims[c], cubic_);
    const std::array<std::size_t, 3> strides{
        1, static_cast<std::size_t>(field_.dims.x),
        static_cast<std::size_t>(field_.dims.x) * static_cast<std::size_t>(field_.dims.y)};
    const std::span<const float> values = cubic_ ? field_.coefficients : field_.values;
    const std::size_t stride = strides[static_cast<std::size_t>(axis_)];
    const auto length = static_cast<std::size_t>(field_.dims[axis_]);
    double* const out = nodes_.data() + (cubic_ ? 1 : 0);
    std::fill_n(out, length, 0.0);
    for (std::size_t l = 0; l < tc.count; ++l)
        for (std::size_t k = 0; k < tb.count; ++k) {
            const double weight = tb.beside.weights[k] * tc.beside.weights[l];
            const float* from = values.data() +
                                static_cast<std::size_t>(tb.beside.places[k]) * strides[static_cast<std::size_t>(b)] +
                                static_cast<std::size_t>(tc.beside.places[l]) * strides[static_cast<std::size_t>(c)];
            for (std::size_t x = 0; x < length; ++x, from += stride)
                out[x] += weight * static_cast<double>(*from);
        }
    if (cubic_) {
        nodes_.front() = 2 * out[0] - out[std::min<std::size_t>(1, length - 1)];
        nodes_.back() = 2 * out[length - 1] - out[length < 2 ? 0 : length - 2];
    }
}

glm::dvec3 FieldLine::at(double t) const {
    glm::dvec3 x = across_;
    x[axis_] = t;
    return x;
}

glm::dvec3 FieldLine::slope(double t) const {
    const glm::dvec3 x = at(t);
    glm::dvec3 g = reference::spline_gradient(field_, x);
    // Beyond the outermost samples the field is constant along that axis.
    for (int a = 0; a < 3; ++a)
        if (x[a] < 0 || x[a] > field_.dims[a] - 1) g[a] = 0;
    return g;
}

double FieldLine::value_at_first() const {
    return cubic_ ? at_knot(nodes_.data()) : nodes_.front();
}

void FieldLine::for_crossings(double iso, const std::function<void(double)>& crossing) const {
    const int cells = field_.dims[axis_] - 1;
    for (int cell = 0; cell < cells; ++cell) {
        const double* v = nodes_.data() + cell;
        if (!cubic_) {
            if ((v[0] >= iso) != (v[1] >= iso)) crossing(cell + (iso - v[0]) / (v[1] - v[0]));
            continue;
        }
        // The spline is bounded by its coefficients.
        const auto [least, most] = std::minmax({v[0], v[1], v[2], v[3]});
        if (least >= iso || most < iso) continue;
        const Cubic f(v);
        std::array<double, 4> ends{};
        const int count = f.monotonous(ends);
        for (std::size_t i = 0; i + 1 < static_cast<std::size_t>(count); ++i) {
            double low = ends[i], high = ends[i + 1];
            const bool from = f(low) >= iso;
            // Evaluates the knot exactly as the next cell does, so that no crossing is lost or doubled.
            const bool to = (high == 1 ? at_knot(v + 1) : f(high)) >= iso;
            if (from == to) continue;
            for (int k = 0; k < kHalvings; ++k) {
                const double middle = (low + high) / 2;
                ((f(middle) >= iso) == from ? low : high) = middle;
            }
            crossing(cell + (low + high) / 2);
        }
    }
}

}  // namespace edgesplat::measure

#include "engine/measure/field_lines.h"

#include <algorithm>
#include <cmath>

namespace edgesplat::measure {
namespace {

constexpr int kHalvings = 40;

/// Weights of the samples, or of the spline's coefficients, beside a place on an axis.
struct Taps {
    std::array<double, 4> weights{};
    std::array<int, 4> places{};
    int count = 0;
};

Taps taps(double place, int size, bool cubic) {
    const double p = std::clamp(place, 0.0, static_cast<double>(size - 1));
    const int cell = std::min(static_cast<int>(p), std::max(size - 2, 0)), last = size - 1;
    const double t = p - cell, s = 1 - t;
    if (!cubic) return {{s, t}, {cell, std::min(cell + 1, last)}, 2};
    Taps out{{s * s * s / 6, (3 * t * t * t - 6 * t * t + 4) / 6, (3 * s * s * s - 6 * s * s + 4) / 6, t * t * t / 6},
             {},
             4};
    for (int k = 0; k < 4; ++k) {
        const int i = std::abs(cell + k - 1);
        out.places[static_cast<std::size_t>(k)] = std::clamp(i > last ? 2 * last - i : i, 0, last);
    }
    return out;
}

/// The spline at the second of three coefficients.
double at_knot(const double* v) {
    return (v[0] + 4 * v[1] + v[2]) / 6;
}

/// The spline over a cell, t in [0, 1], from the four coefficients around it.
struct Cubic {
    double a, b, c, d;  ///< a + b t + c t^2 + d t^3
    explicit Cubic(const double* v)
        : a(at_knot(v)),
          b((v[2] - v[0]) / 2),
          c((v[0] - 2 * v[1] + v[2]) / 2),
          d((v[3] - v[0] + 3 * (v[1] - v[2])) / 6) {}
    double operator()(double t) const { return a + t * (b + t * (c + t * d)); }
    /// Ends of the pieces on which it rises or falls only: 0, the turns within, 1.
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
    for (int j = 0; j < tc.count; ++j)
        for (int i = 0; i < tb.count; ++i) {
            const auto k = static_cast<std::size_t>(i), l = static_cast<std::size_t>(j);
            const double weight = tb.weights[k] * tc.weights[l];
            const float* from = values.data() +
                                static_cast<std::size_t>(tb.places[k]) * strides[static_cast<std::size_t>(b)] +
                                static_cast<std::size_t>(tc.places[l]) * strides[static_cast<std::size_t>(c)];
            for (std::size_t x = 0; x < length; ++x, from += stride)
                out[x] += weight * static_cast<double>(*from);
        }
    if (cubic_) {
        nodes_.front() = out[std::min<std::size_t>(1, length - 1)];
        nodes_.back() = out[length < 2 ? 0 : length - 2];
    }
}

glm::dvec3 FieldLine::at(double t) const {
    glm::dvec3 x = across_;
    x[axis_] = t;
    return x;
}

glm::dvec3 FieldLine::gradient(double t) const {
    const glm::dvec3 x = at(t);
    if (cubic_) {
        // Beyond the outermost samples the field does not change along that axis.
        glm::dvec3 g = reference::spline_gradient(field_, x);
        for (int a = 0; a < 3; ++a)
            if (x[a] < 0 || x[a] > field_.dims[a] - 1) g[a] = 0;
        return g;
    }
    constexpr double h = 1e-5;
    glm::dvec3 g(0);
    for (int a = 0; a < 3; ++a) {
        glm::dvec3 step(0);
        step[a] = h;
        g[a] = (reference::sample(field_, x + step) - reference::sample(field_, x - step)) / (2 * h);
    }
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
        // The spline stays within its coefficients.
        const auto [least, most] = std::minmax({v[0], v[1], v[2], v[3]});
        if (least >= iso || most < iso) continue;
        const Cubic f(v);
        std::array<double, 4> ends{};
        const int count = f.monotonous(ends);
        for (std::size_t i = 0; i + 1 < static_cast<std::size_t>(count); ++i) {
            double low = ends[i], high = ends[i + 1];
            const bool from = f(low) >= iso;
            // The next cell begins with what this one ends with: compared by its own polynomial, none is lost or
            // doubled.
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

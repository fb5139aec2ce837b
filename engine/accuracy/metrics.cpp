#include "engine/accuracy/metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "engine/error.h"

namespace edgesplat::accuracy {
namespace {

int color_channels(const Image& image) {
    return std::min(image.channels, 3);
}

void check_same_shape(const Image& a, const Image& b) {
    if (a.width != b.width || a.height != b.height || a.channels != b.channels)
        fail("cannot compare a picture of {}x{} pixels and {} channels with one of {}x{} and {}", a.width, a.height,
             a.channels, b.width, b.height, b.channels);
}

/// Root mean square of `value(x, y, c)` over the colour channels of all pixels.
template <typename Value>
double color_rms(const Image& shape, const Value& value) {
    double sum = 0;
    for (int y = 0; y < shape.height; ++y) {
        for (int x = 0; x < shape.width; ++x) {
            for (int c = 0; c < color_channels(shape); ++c) {
                const double v = value(x, y, c);
                sum += v * v;
            }
        }
    }
    return std::sqrt(sum / (static_cast<double>(shape.width) * shape.height * color_channels(shape)));
}

double difference(const Image& a, const Image& b, int x, int y, int c) {
    return static_cast<double>(a.at(x, y, c)) - static_cast<double>(b.at(x, y, c));
}

/// Whether the profile falls from at least `level` to below it between samples i - 1 and i.
bool falls(std::span<const double> profile, std::size_t i, double level) {
    return profile[i] < level && profile[i - 1] >= level;
}

double crossing(std::span<const double> profile, std::size_t i, double level) {
    return static_cast<double>(i - 1) + (profile[i - 1] - level) / (profile[i - 1] - profile[i]);
}

std::optional<double> first_below(std::span<const double> profile, double level) {
    for (std::size_t i = 1; i < profile.size(); ++i)
        if (falls(profile, i, level)) return crossing(profile, i, level);
    return {};
}

/// The last crossing before sample `end`: ripple of the inside is not the edge.
std::optional<double> last_below(std::span<const double> profile, double level, double end) {
    for (std::size_t i = std::min(profile.size(), static_cast<std::size_t>(std::ceil(end)) + 1); i-- > 1;)
        if (falls(profile, i, level)) return crossing(profile, i, level);
    return {};
}

}  // namespace

ImageError image_error(const Image& picture, const Image& expected) {
    check_same_shape(picture, expected);
    ImageError error;
    error.rms = color_rms(picture, [&](int x, int y, int c) {
        const double d = std::abs(difference(picture, expected, x, y, c));
        error.max = std::isnan(d) ? std::numeric_limits<double>::infinity() : std::max(error.max, d);
        return d;
    });
    return error;
}

double decibels(const ImageError& error) {
    return -20 * std::log10(error.rms);
}

ImageError pooled(std::span<const ImageError> errors) {
    ImageError all;
    if (errors.empty()) return all;
    for (const ImageError& e : errors) {
        all.rms += e.rms * e.rms;
        all.max = std::max(all.max, e.max);
    }
    all.rms = std::sqrt(all.rms / static_cast<double>(errors.size()));
    return all;
}

std::optional<ProfileEdge> profile_edge(std::span<const double> profile, double first, double step) {
    const auto low = first_below(profile, 0.1), half = first_below(profile, 0.5);
    const auto high = low ? last_below(profile, 0.9, *low) : std::nullopt;
    if (!low || !half || !high) return {};
    return ProfileEdge{(*low - *high) * step, first + *half * step};
}

Popping popping(std::span<const Image> method, std::span<const Image> reference) {
    if (method.size() != reference.size() || method.size() < 2)
        fail("popping: {} frames and {} references, expected equal numbers of at least two", method.size(),
             reference.size());
    Popping result;
    for (std::size_t i = 0; i + 1 < method.size(); ++i) {
        check_same_shape(method[i], reference[i]);
        check_same_shape(method[i], method[i + 1]);
        check_same_shape(reference[i], reference[i + 1]);
        const auto change = [i](std::span<const Image> frames) {
            return [i, frames](int x, int y, int c) { return difference(frames[i + 1], frames[i], x, y, c); };
        };
        const auto of_method = change(method), of_reference = change(reference);
        const double excess = color_rms(method[i], of_method) - color_rms(method[i], of_reference);
        const double apart =
            color_rms(method[i], [&](int x, int y, int c) { return of_method(x, y, c) - of_reference(x, y, c); });
        result.mean_excess += excess;
        result.mean_difference += apart;
        result.max_excess = i == 0 ? excess : std::max(result.max_excess, excess);
        result.max_difference = std::max(result.max_difference, apart);
    }
    result.mean_excess /= static_cast<double>(method.size() - 1);
    result.mean_difference /= static_cast<double>(method.size() - 1);
    return result;
}

double quantile(std::vector<double> values, double q) {
    if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
    std::sort(values.begin(), values.end());
    const double at = std::clamp(q, 0.0, 1.0) * static_cast<double>(values.size() - 1);
    const auto below = static_cast<std::size_t>(at);
    const std::size_t above = std::min(below + 1, values.size() - 1);
    return std::lerp(values[below], values[above], at - static_cast<double>(below));
}

Spread spread(const std::vector<double>& values) {
    return {quantile(values, 0.5), quantile(values, 0.1), quantile(values, 0.9)};
}

std::vector<std::size_t> pareto_front(std::span<const CostAndError> points) {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (!std::isnan(points[i].cost) && !std::isnan(points[i].error)) order.push_back(i);
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return points[a].cost != points[b].cost ? points[a].cost < points[b].cost : points[a].error < points[b].error;
    });
    std::vector<std::size_t> front;
    for (const std::size_t i : order)
        if (front.empty() || points[i].error < points[front.back()].error) front.push_back(i);
    return front;
}

}  // namespace edgesplat::accuracy

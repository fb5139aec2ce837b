#include "footprints/footprint_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <thread>

#include "footprints/gauss_legendre.h"
#include "footprints/kernel.h"
#include "footprints/table_coordinates.h"

namespace edgesplat {
namespace {

constexpr std::size_t kNodesInAll = 48;  // on both sides of the edge
constexpr int kNodes = 24;               // per half band; the table's own error is far above this rule's

// One column of a layer: every y at one X. The nodes of the integral do not depend on y, only K's argument does, so the
// displacement is worked out once a column.
void integrate_column(const EdgeBand& band, double d, double c, double X, double extent_y,
                      std::span<std::uint16_t> column, std::size_t stride, int height) {
    static const QuadratureRule rule = gauss_legendre(kNodes);
    const double s = std::sqrt(1 - c * c);
    const double x = table_x_of(X, d, c, band);
    const double pn = x * s, R = kKernelRadius, a = band.half_width;

    std::array<double, kNodesInAll> r2{};
    std::array<double, kNodesInAll> weight{};
    // The ray's pieces on either side of the edge, within the band, the kernel (w in [-R, R]) and the cylinder around
    // n.
    const double s2 = std::max(s * s, 1e-6);
    const double middle = pn * c / s2, half = R / std::sqrt(s2);
    const double first = std::max(d - a, d + edge_warp_inverse(-R - d, band));
    const double last = std::min(d + a, d + edge_warp_inverse(R - d, band));
    const std::array<double, 3> ends = {first, d, last};
    for (std::size_t p = 0; p < 2; ++p) {
        const double start = std::max((ends[p] - pn) / c, middle - half);
        const double length = std::max(0.0, std::min((ends[p + 1] - pn) / c, middle + half) - start);
        for (std::size_t i = 0; i < kNodes; ++i) {
            const double z = start + length * rule.nodes[i], t = pn + z * c, w = d + edge_warp(t - d, band);
            r2[p * kNodes + i] = x * x + z * z + (w - t) * (w + t);
            weight[p * kNodes + i] = length * rule.weights[i];
        }
    }
    for (int j = 0; j < height; ++j) {
        const double y = extent_y * j / (height - 1), y2 = y * y, rho2 = x * x + y2;
        double sum = 0;
        for (std::size_t i = 0; i < r2.size(); ++i)
            sum += weight[i] * kernel(r2[i] + y2);
        sum += kernel_footprint(rho2) - kernel_chord(rho2, (d + a - pn) / c) + kernel_chord(rho2, (d - a - pn) / c);
        column[static_cast<std::size_t>(j) * stride] =
            half_from_float(static_cast<float>(sum - kernel_footprint(X * X + y2)));
    }
}

}  // namespace

std::size_t FootprintTableSize::texels() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * static_cast<std::size_t>(distances) *
           static_cast<std::size_t>(directions);
}

void validate(const EdgeBand& band, const FootprintTableSize& size) {
    if (!(band.half_width > 0 && band.half_width <= 3))
        throw std::invalid_argument(fmt::format("footprint table: half_width = {} must be in (0, 3]", band.half_width));
    if (!(band.strength >= 1 && band.strength <= 64))
        throw std::invalid_argument(fmt::format("footprint table: strength = {} must be in [1, 64]", band.strength));
    const auto within = [](int n, int most) { return n >= 2 && n <= most; };
    if (!within(size.width, 4096) || !within(size.height, 4096) || !within(size.distances, 1024) ||
        !within(size.directions, 1024) || size.distances * size.directions > 2048)
        throw std::invalid_argument(fmt::format(
            "footprint table: {} x {} texels, {} x {} layers; every size must be at least 2, layers at most 2048",
            size.width, size.height, size.distances, size.directions));
}

FootprintTable::FootprintTable(const EdgeBand& band, const FootprintTableSize& size, std::vector<std::uint16_t> texels)
    : band_(band), size_(size), extent_(table_extent(band)), texels_(std::move(texels)) {
    validate(band, size);
    if (texels_.size() != size.texels())
        throw std::invalid_argument(
            fmt::format("footprint table: {} texels given, {} expected", texels_.size(), size.texels()));
}

FootprintTable FootprintTable::build(const EdgeBand& band, const FootprintTableSize& size, int threads) {
    validate(band, size);
    FootprintTable table(band, size, std::vector<std::uint16_t>(size.texels()));
    const std::size_t width = static_cast<std::size_t>(size.width), height = static_cast<std::size_t>(size.height);
    const double reach = kKernelRadius + band.half_width;

    std::atomic<int> next_layer{0};
    const auto work = [&] {
        for (int layer; (layer = next_layer++) < size.distances * size.directions;) {
            const double d = reach * (layer / size.directions) / (size.distances - 1);
            const int direction = layer % size.directions;
            // Seen edge-on the base is exact, and at d = R + a nothing is warped: those layers stay 0.
            if (direction == 0 || layer / size.directions == size.distances - 1) continue;
            const double c = table_direction(static_cast<double>(direction) / (size.directions - 1));
            const std::span<std::uint16_t> texels =
                std::span(table.texels_).subspan(static_cast<std::size_t>(layer) * width * height, width * height);
            for (std::size_t i = 0; i < width; ++i) {
                const double X = table.extent_ * (2.0 * static_cast<double>(i) / (size.width - 1) - 1);
                integrate_column(band, d, c, X, kKernelRadius, texels.subspan(i), width, size.height);
            }
        }
    };
    if (threads <= 0) threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    std::vector<std::jthread> workers;
    for (int i = 1; i < threads; ++i)
        workers.emplace_back(work);
    work();
    workers.clear();  // joins
    return table;
}

double FootprintTable::sample(int distance_index, int direction_index, double X, double y) const {
    // Bilinear between texel centres, clamped to the edge, as the sampler does it.
    const double u = std::clamp((X / extent_ + 1) / 2, 0.0, 1.0) * (size_.width - 1);
    const double v = std::clamp(y / kKernelRadius, 0.0, 1.0) * (size_.height - 1);
    const int i = std::min(static_cast<int>(u), size_.width - 2), j = std::min(static_cast<int>(v), size_.height - 2);
    const double fu = u - i, fv = v - j;
    const std::size_t width = static_cast<std::size_t>(size_.width);
    const std::size_t layer = static_cast<std::size_t>(distance_index * size_.directions + direction_index);
    const std::uint16_t* at = texels_.data() +
                              (layer * static_cast<std::size_t>(size_.height) + static_cast<std::size_t>(j)) * width +
                              static_cast<std::size_t>(i);
    const auto texel = [&](std::size_t offset) { return static_cast<double>(float_from_half(at[offset])); };
    return (1 - fv) * ((1 - fu) * texel(0) + fu * texel(1)) + fv * ((1 - fu) * texel(width) + fu * texel(width + 1));
}

double FootprintTable::nearest(const Ray& ray, double distance) const {
    if (!(std::abs(distance) < kKernelRadius + band_.half_width)) return kernel_footprint(ray.rho2);
    const TablePoint p = table_point(ray, distance, band_);
    const double d = p.distance / (kKernelRadius + band_.half_width) * (size_.distances - 1);
    const int i = std::min(static_cast<int>(d + 0.5), size_.distances - 1);
    const int j = std::min(static_cast<int>(p.direction * (size_.directions - 1) + 0.5), size_.directions - 1);
    const double shift = (i - d) * (kKernelRadius + band_.half_width) / (size_.distances - 1) * p.sine;
    return std::max(0.0, kernel_footprint(p.base_r2) + sample(i, j, p.X + shift, p.y));
}

double FootprintTable::lerp(const Ray& ray, double distance) const {
    if (!(std::abs(distance) < kKernelRadius + band_.half_width)) return kernel_footprint(ray.rho2);
    const TablePoint p = table_point(ray, distance, band_);
    const double spacing = (kKernelRadius + band_.half_width) / (size_.distances - 1);
    const double d = p.distance / spacing, c = p.direction * (size_.directions - 1);
    const int i = std::min(static_cast<int>(d), size_.distances - 2),
              j = std::min(static_cast<int>(c), size_.directions - 2);
    const double fd = d - i, fc = c - j;
    // Along n by the layer's offset in d: the edge stands still between layers.
    const double X0 = p.X - fd * spacing * p.sine, X1 = p.X + (1 - fd) * spacing * p.sine;
    const double near = (1 - fc) * sample(i, j, X0, p.y) + fc * sample(i, j + 1, X0, p.y);
    const double far = (1 - fc) * sample(i + 1, j, X1, p.y) + fc * sample(i + 1, j + 1, X1, p.y);
    return std::max(0.0, kernel_footprint(p.base_r2) + (1 - fd) * near + fd * far);
}

std::uint16_t half_from_float(float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    const std::uint32_t sign = bits >> 16U & 0x8000U, magnitude = bits & 0x7fffffffU;
    std::uint32_t half = 0;
    if (magnitude > 0x7f800000U) {
        half = 0x7e00U;  // NaN
    } else if (magnitude >= 0x477ff000U) {
        half = 0x7c00U;  // 65520 and more round to infinity
    } else if (magnitude >= 0x38800000U) {
        half = (magnitude - 0x38000000U + 0xfffU + (magnitude >> 13U & 1U)) >> 13U;  // ties to the even one
    } else {
        // Below 2^-14 halves are 2^-24 apart, as floats are next to 0.5: the addition rounds.
        half = std::bit_cast<std::uint32_t>(std::abs(value) + 0.5F) - std::bit_cast<std::uint32_t>(0.5F);
    }
    return static_cast<std::uint16_t>(sign | half);
}

float float_from_half(std::uint16_t half) {
    const int exponent = half >> 10 & 31, mantissa = half & 1023;
    float magnitude = 0;
    if (exponent == 31) {
        magnitude = mantissa == 0 ? std::numeric_limits<float>::infinity() : std::numeric_limits<float>::quiet_NaN();
    } else if (exponent == 0) {
        magnitude = std::ldexp(static_cast<float>(mantissa), -24);
    } else {
        magnitude = std::ldexp(static_cast<float>(1024 + mantissa), exponent - 25);
    }
    return (half & 0x8000) != 0 ? -magnitude : magnitude;
}

}  // namespace edgesplat

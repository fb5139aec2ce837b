#include "footprints/footprint_table.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>

#include "footprints/plane_face.h"
#include "shaders/shared/footprint_table.h"

namespace edgesplat {
namespace {

constexpr int kDistances = shader::TABLE_DISTANCES, kDirections = shader::TABLE_DIRECTIONS;
constexpr int kWidth = shader::TABLE_WIDTH, kRows = shader::TABLE_ROWS;
constexpr int kBefore = shader::TABLE_BEFORE, kAcross = shader::TABLE_ACROSS, kBeside = shader::TABLE_BESIDE;
constexpr double kSteps = shader::TABLE_BLEND_STEPS;
constexpr int kNodes = 16;             // on either side of the depth from which points are moved
constexpr double kShortest = 1e-6;     // voxels: shortest stretch of x that has texels
constexpr double kLeastCosine = 1e-4;  // layers of edge-on faces are computed at this cosine
constexpr double kNoWidth = 1e-9;      // voxels to either side of the end of a stretch

/// Sine and cosine of an angle from the tangent of its half, and the tangent from the sine.
double sine_of(double tangent) {
    return 2 * tangent / (1 + tangent * tangent);
}
double cosine_of(double tangent) {
    return (1 - tangent * tangent) / (1 + tangent * tangent);
}
double tangent_of(double sine) {
    return sine / (1 + std::sqrt(std::max(1 - sine * sine, 0.0)));
}

/// The x at which one stretch of texels in a layer's row ends and the next begins.
struct Stretches {
    double begin, across, beside, end;
};

Stretches stretches(const FootprintLayer& layer, double y, double radius) {
    const double half = layer.cosine * std::sqrt(std::max(layer.rim2 - y * y, 0.0));
    const double ball = std::sqrt(std::max(radius * radius - y * y, 0.0));
    const double across = std::max(layer.middle - half, -ball), beside = std::max(layer.middle + half, -ball);
    return {-ball, across, beside, std::max(ball, beside)};
}

/// The texel of x, counted from the centre of the first.
double texel_of(const Stretches& s, double x) {
    const auto share = [&](double low, double high) {
        return std::clamp((x - low) / std::max(high - low, kShortest), 0.0, 1.0);
    };
    if (x < s.across) return share(s.begin, s.across) * (kBefore - 1);
    if (x < s.beside) return kBefore + share(s.across, s.beside) * (kAcross - 1);
    return kBefore + kAcross + share(s.beside, s.end) * (kBeside - 1);
}

/// The x of a texel, moved slightly to its own side at the end of a stretch.
double place_of(const Stretches& s, int texel) {
    if (texel < kBefore) return std::lerp(s.begin, s.across, texel / (kBefore - 1.0)) - kNoWidth;
    if (texel < kBefore + kAcross) return std::lerp(s.across, s.beside, (texel - kBefore) / (kAcross - 1.0));
    return std::lerp(s.beside, s.end, (texel - kBefore - kAcross) / (kBeside - 1.0)) + kNoWidth;
}

/// The whole footprint along a ray, by the reference's integral of faces.
double plane_footprint(const Ray& ray, double distance, double depth) {
    const FaceCut cut = face_cut(distance, 0, 0, FACE_NOWHERE, depth, kernel_of_table(depth));
    const FacePath path(plane_face(ray, distance), cut, kNoCrease, kernel_of_table(depth));
    const double turns = (distance - depth - ray.pn) / ray.un;
    return path.footprint(kNodes, {.high = turns}).integral + path.footprint(kNodes, {.low = turns}).integral;
}

std::uint32_t coded(double place, int layers, std::uint32_t& index) {
    index = static_cast<std::uint32_t>(std::clamp(std::floor(place), 0.0, layers - 2.0));
    return static_cast<std::uint32_t>(std::lround(std::clamp(place - index, 0.0, 1.0) * kSteps));
}

}  // namespace

const Kernel& kernel_of_table(double depth) {
    return depth == FACE_DEPTH ? kNarrowKernel : kKernel;
}

FootprintLayer decode_footprint_layer(std::uint32_t code, double depth) {
    constexpr std::uint32_t kMask = (1U << shader::TABLE_BLEND_BITS) - 1;
    const std::uint32_t layer = code & kMask;
    const double distance = layer / kDirections + (code >> shader::TABLE_BLEND_BITS & kMask) / kSteps;
    const double direction = layer % kDirections + (code >> 2 * shader::TABLE_BLEND_BITS & kMask) / kSteps;
    const double of_distance = 2 * distance / (kDistances - 1) - 1, of_direction = direction / (kDirections - 1);
    const double radius = kernel_of_table(depth).radius, rim = radius * cosine_of(of_distance);
    return {code, (radius * sine_of(of_distance) + depth) * cosine_of(of_direction), sine_of(of_direction), rim * rim};
}

FootprintLayer select_footprint_layer(double distance, double cosine, double depth) {
    const double e = std::clamp((distance - depth) / kernel_of_table(depth).radius, -1.0, 1.0);
    std::uint32_t i = 0, j = 0;
    const std::uint32_t to_next = coded((tangent_of(e) + 1) / 2 * (kDistances - 1), kDistances, i);
    const std::uint32_t turned = coded(tangent_of(std::clamp(cosine, 0.0, 1.0)) * (kDirections - 1), kDirections, j);
    return decode_footprint_layer(
        (i * kDirections + j) | to_next << shader::TABLE_BLEND_BITS | turned << 2 * shader::TABLE_BLEND_BITS, depth);
}

FootprintLayer plain_footprint_layer(double depth) {
    return select_footprint_layer(kernel_of_table(depth).radius + depth, 1, depth);
}

FootprintTable::FootprintTable(double depth)
    : depth_(depth), texels_(std::size_t{kWidth} * kRows * shader::TABLE_LAYERS) {
    const double radius = kernel_of_table(depth).radius;
    std::size_t at = 0;
    for (int i = 0; i < kDistances; ++i) {
        for (int j = 0; j < kDirections; ++j) {
            const double e = radius * sine_of(2.0 * i / (kDistances - 1) - 1);
            const double c = std::max(sine_of(j / (kDirections - 1.0)), kLeastCosine);
            const double s = std::sqrt(std::max(1 - c * c, 0.0));
            const FootprintLayer layer{0, (e + depth) * s, c, radius * radius - e * e};
            for (int row = 0; row < kRows; ++row) {
                const double y = radius * row / (kRows - 1);
                const Stretches along = stretches(layer, y, radius);
                for (int texel = 0; texel < kWidth; ++texel) {
                    const double x = place_of(along, texel);
                    const Ray ray{x * x + y * y, x * s, c};
                    texels_.at(at++) = half_from_float(static_cast<float>(plane_footprint(ray, e + depth, depth)));
                }
            }
        }
    }
}

double FootprintTable::lookup(const FootprintLayer& layer, double x, double y) const {
    constexpr std::uint32_t kMask = (1U << shader::TABLE_BLEND_BITS) - 1;
    const double radius = kernel_of_table(depth_).radius;
    const double u = texel_of(stretches(layer, y, radius), x), v = std::clamp(y / radius, 0.0, 1.0) * (kRows - 1);
    const int column = std::min(static_cast<int>(u), kWidth - 2), row = std::min(static_cast<int>(v), kRows - 2);
    const auto texel = [&](std::size_t number, int i, int j) {
        const std::size_t at = (number * kRows + static_cast<std::size_t>(j)) * kWidth + static_cast<std::size_t>(i);
        return static_cast<double>(float_from_half(texels_[at]));
    };
    const auto sample = [&](std::size_t number) {
        const auto across = [&](int j) {
            return std::lerp(texel(number, column, j), texel(number, column + 1, j), u - column);
        };
        return std::lerp(across(row), across(row + 1), v - row);
    };
    const double to_next = (layer.code >> shader::TABLE_BLEND_BITS & kMask) / kSteps;
    const double turned = (layer.code >> 2 * shader::TABLE_BLEND_BITS & kMask) / kSteps;
    const std::size_t first = layer.code & kMask, next = first + kDirections;
    return std::lerp(std::lerp(sample(first), sample(first + 1), turned),
                     std::lerp(sample(next), sample(next + 1), turned), to_next);
}

const FootprintTable& kept_footprint_table(double depth) {
    static std::mutex mutex;
    static std::map<double, FootprintTable> tables;
    const std::scoped_lock lock(mutex);
    return tables.try_emplace(depth, depth).first->second;
}

std::uint16_t half_from_float(float value) {
    // Below 2^-14 halves are 2^-24 apart, as floats are next to 0.5: the addition rounds.
    if (value < 0x1p-14F)
        return static_cast<std::uint16_t>(std::bit_cast<std::uint32_t>(value + 0.5F) -
                                          std::bit_cast<std::uint32_t>(0.5F));
    const auto bits = std::bit_cast<std::uint32_t>(value);
    return static_cast<std::uint16_t>((bits - 0x38000000U + 0xfffU + (bits >> 13U & 1U)) >> 13U);
}

float float_from_half(std::uint16_t half) {
    const int exponent = half >> 10, mantissa = half & 1023;
    return exponent == 0 ? std::ldexp(static_cast<float>(mantissa), -24)
                         : std::ldexp(static_cast<float>(1024 + mantissa), exponent - 25);
}

}  // namespace edgesplat

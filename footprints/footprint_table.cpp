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

namespace in_double {
namespace {

using namespace shader;

/// table_layer.glsl and table_lookup.glsl, with the table that they ask for.
struct TableSource {
    explicit TableSource(double depth, const std::uint16_t* texels = nullptr)
        : KERNEL_R(kernel_of_table(depth).radius), KERNEL_R2(KERNEL_R * KERNEL_R), halves(texels) {}

    using FootprintLayer = edgesplat::FootprintLayer;
    double KERNEL_R, KERNEL_R2;
    static constexpr uint TABLE_MASK = (1U << TABLE_BLEND_BITS) - 1;
    static constexpr double TABLE_BLEND_STEPS = static_cast<double>(shader::TABLE_BLEND_STEPS);
    const std::uint16_t* halves;

    static double mix(double a, double b, double t) { return std::lerp(a, b, t); }
    static double floor(double v) { return std::floor(v); }

    /// As a sampler with linear filter.
    double table_texel(double x, double y, double layer) const {
        const double column = min(floor(x), TABLE_WIDTH - 2.0), row = min(floor(y), TABLE_ROWS - 2.0);
        const auto texel = [&](double i, double j) {
            const double at = (layer * TABLE_ROWS + j) * TABLE_WIDTH + i;
            return static_cast<double>(float_from_half(halves[static_cast<std::size_t>(at)]));
        };
        const auto across = [&](double j) { return mix(texel(column, j), texel(column + 1, j), x - column); };
        return mix(across(row), across(row + 1), y - row);
    }

#define Real double
#include "footprints/table_layer.glsl"
// After what it uses.
#include "footprints/table_lookup.glsl"
#undef Real
};

}  // namespace
}  // namespace in_double

namespace {

constexpr int kDistances = shader::TABLE_DISTANCES, kDirections = shader::TABLE_DIRECTIONS;
constexpr int kWidth = shader::TABLE_WIDTH, kRows = shader::TABLE_ROWS;
constexpr int kBefore = shader::TABLE_BEFORE, kAcross = shader::TABLE_ACROSS, kBeside = shader::TABLE_BESIDE;
constexpr int kNodes = 16;             // on either side of the depth from which points are moved
constexpr double kLeastCosine = 1e-4;  // layers of edge-on faces are computed at this cosine
constexpr double kNoWidth = 1e-9;      // voxels to either side of the end of a stretch

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

}  // namespace

const Kernel& kernel_of_table(double depth) {
    return depth == FACE_DEPTH ? kNarrowKernel : kKernel;
}

FootprintLayer decode_footprint_layer(std::uint32_t code, double depth) {
    return in_double::TableSource(depth).decode_footprint_layer(code, depth);
}

FootprintLayer select_footprint_layer(double distance, double cosine, double depth) {
    return decode_footprint_layer(in_double::TableSource(depth).select_footprint_layer(distance, cosine, depth), depth);
}

FootprintLayer plain_footprint_layer(double depth) {
    return select_footprint_layer(kernel_of_table(depth).radius + depth, 1, depth);
}

FootprintTable::FootprintTable(double depth)
    : depth_(depth), texels_(std::size_t{kWidth} * kRows * shader::TABLE_LAYERS) {
    in_double::TableSource source(depth);
    const double radius = source.KERNEL_R;
    std::size_t at = 0;
    for (int i = 0; i < kDistances; ++i) {
        for (int j = 0; j < kDirections; ++j) {
            const double e = radius * source.half_sine(2.0 * i / (kDistances - 1) - 1);
            const double c = std::max(source.half_sine(j / (kDirections - 1.0)), kLeastCosine);
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
    return in_double::TableSource(depth_, texels_.data()).footprint_looked_up(layer, x, x * x + y * y);
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

#include "engine/reference/traced_face.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "engine/reference/volume_piece.h"
#include "shaders/shared/limits.h"

namespace edgesplat::reference {

namespace {

using glm::dvec3;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr auto kTraceStep = static_cast<double>(shader::TRACE_STEP);
constexpr auto kTraceDeep = static_cast<double>(shader::TRACE_DEEP);
constexpr auto kTraceReach = static_cast<double>(shader::TRACE_REACH);

/// The field along a ray.
struct Along {
    const Field& field;
    dvec3 eye, u;
    double value(double z) const { return sample(field, eye + z * u, true); }
    double slope(double z) const { return glm::dot(spline_gradient(field, eye + z * u), u); }
};

struct Sample {
    double z = 0, value = 0, slope = 0;
};

/// Where the cubic between two samples on the same side of the interval's ends crosses an end and turns back.
std::optional<double> turn_between(const Sample& a, const Sample& b, const VoxelEdge::Interval& interval) {
    const double step = b.z - a.z, d0 = a.slope * step, d1 = b.slope * step;
    if (!(d0 * d1 < 0)) return std::nullopt;
    const double at = d0 / (d0 - d1), rest = 1 - at;
    const double value =
        rest * rest * (a.value * (1 + 2 * at) + d0 * at) + at * at * (b.value * (3 - 2 * at) - d1 * rest);
    if (interval.holds(value) == interval.holds(a.value)) return std::nullopt;
    return a.z + at * step;
}

/// Where the field is `level`, between two places with the level between their values.
double root(const Along& along, double level, double a, double b) {
    const bool rises = along.value(b) > along.value(a);
    for (int step = 0; step < 60; ++step) {
        const double m = 0.5 * (a + b);
        ((along.value(m) < level) == rises ? a : b) = m;
    }
    return 0.5 * (a + b);
}

}  // namespace

bool has_two_values(const Field& field, const glm::ivec3& i) {
    std::array<double, 27> around{};
    for (int k = 0; k < 27; ++k)
        around[static_cast<std::size_t>(k)] = field.at(i + glm::ivec3(k % 3, k / 3 % 3, k / 9) - 1);
    const auto ends = std::ranges::minmax(around);
    return std::ranges::all_of(
        around, [&](double f) { return std::min(f - ends.min, ends.max - f) <= 1e-3 * (ends.max - ends.min); });
}

TracedRay trace_ray(const Field& field, const dvec3& eye, const dvec3& u, double first, double last,
                    const VoxelEdge::Interval& interval) {
    const Along along{field, eye, u};
    const VolumePiece whole = piece_in_volume(field.dims, eye, u);
    const bool at_border = whole.low > 0 && first <= whole.low;
    first = std::max(first, whole.low);
    TracedRay ray;
    if (!(first < std::min(last, whole.high))) return ray;
    Sample before;
    bool begun = false;
    // Returns false if nothing further along the ray counts.
    const auto take = [&](const Sample& at) {
        const bool matter = interval.holds(at.value), was = begun && interval.holds(before.value);
        ray.last = at.z;
        // Matter that the ray is in when it enters the volume begins at the border, with the border's normal.
        if (!begun && matter && at_border) ray.pieces.push_back({whole.low, kInfinity, whole.normal, false});
        if (!begun && matter && !at_border) ray.pieces.push_back({-kInfinity, kInfinity, dvec3(0), false});
        if (begun && matter != was) {
            const double outer = matter ? before.value : at.value;
            const bool upper = !(outer < interval.low);
            const double z = root(along, upper ? interval.high : interval.low, before.z, at.z);
            if (!matter) ray.pieces.back().end = z;
            const dvec3 g = spline_gradient(field, eye + z * u);
            if (matter && ray.pieces.size() == 2) return false;
            if (matter) ray.pieces.push_back({z, kInfinity, glm::normalize(upper ? g : -g), upper});
            if (!matter && ray.pieces.size() == 2) return false;
        }
        begun = true;
        before = at;
        if (!matter || !was) return true;
        const double entered = ray.pieces.back().begin;
        return at.z - (std::isfinite(entered) ? entered : first) <= kTraceDeep;
    };
    const auto sampled = [&](double z) { return Sample{z, along.value(z), along.slope(z)}; };
    const auto end = static_cast<std::int64_t>(std::ceil(std::min(last, whole.high) / kTraceStep));
    for (auto k = static_cast<std::int64_t>(std::floor(first / kTraceStep)); k <= end; ++k) {
        const Sample next = sampled(std::clamp(static_cast<double>(k) * kTraceStep, whole.low, whole.high));
        if (begun && interval.holds(next.value) == interval.holds(before.value)) {
            const auto turn = turn_between(before, next, interval);
            if (turn && !take(sampled(*turn))) return ray;
        }
        if (!take(next)) return ray;
    }
    ray.last = std::max(ray.last, last);
    return ray;
}

MetEdge met_edge(const VoxelEdge& edge, const Field& field, const dvec3& eye, const dvec3& u, const dvec3& p,
                 double ahead) {
    MetEdge met{edge};
    const double half_chord = std::sqrt(std::max(kTraceReach * kTraceReach - glm::dot(p, p), 0.0));
    const double low = std::max(ahead - half_chord, 0.0), high = ahead + half_chord;
    if (!edge.traced || !(half_chord > 0) || !(low < high)) return met;
    const TracedRay ray = trace_ray(field, eye, u, low, high, *edge.traced);
    const TracedPiece* longest = nullptr;
    double most = 0;
    for (const TracedPiece& piece : ray.pieces) {
        const double length = std::min(piece.end, high) - std::max(piece.begin, low);
        if (length > most) {
            longest = &piece;
            most = length;
        }
    }
    if (!longest) {
        // Beyond the range that was traced, the splat keeps its quadric.
        met.matter = ray.last < high - 1e-3;
        return met;
    }
    const bool enters = longest->begin > low, leaves = longest->end < high;
    if (enters) {
        VoxelEdge& face = met.edge;
        face.traced.reset();
        face.n = longest->n;
        face.D = glm::dot(face.n, p + (longest->begin - ahead) * u);
        face.bending = glm::dmat3(0);
        face.upper = longest->upper;
        face.mixed = false;
        face.D2 = kInfinity;
        if (leaves) face.D2 = std::max((longest->end - longest->begin) * std::abs(glm::dot(u, face.n)), 0.05) - face.D;
    } else if (!leaves) {
        // Matter along the whole chord: the face is put too far away to cut it.
        met.edge.traced.reset();
        met.edge.n = glm::normalize(edge.n - edge.bending * (edge.D * edge.n));
        met.edge.D = static_cast<double>(shader::TRACE_WHOLE);
        met.edge.bending = glm::dmat3(0);
        met.edge.D2 = kInfinity;
    } else {
        // The ray only leaves matter here; splats in front show that matter.
        met.matter = false;
    }
    return met;
}

}  // namespace edgesplat::reference

#include "engine/reference/truth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "engine/reference/7_resolve.h"
#include "engine/scene/transfer_function.h"
#include "shaders/shared/raycast_params.h"

namespace edgesplat::reference {

namespace {

constexpr double kStep = 0.25;         ///< voxels between the probes of a ray
constexpr double kSlopeStep = 1e-4;    ///< voxels, for the numerical gradient of a distance
constexpr double kFinestProbe = 1e-7;  ///< voxels: precision of an extremum along a ray
constexpr int kDeepestHalving = 40;
constexpr int kNoMatter = -1;  ///< the material where the scene has none

/// A point of a ray.
struct Probe {
    double t = 0;
    double value = 0;
    double distance = 0;  ///< to the nearest edge; 0 if the scene has no distance
    int material = 0;
};

/// Integrates rays one after another. Positions are in index space, t in voxels.
class TruthWalker {
  public:
    TruthWalker(const AnalyticScene& scene, const Scene& look, const View& view, double tolerance)
        : scene_(scene), look_(look), view_(view), cut_(tolerance / 10), tolerance_(tolerance - cut_) {}

    RaySum walk(const glm::dvec3& u) {
        sum_ = {};
        u_ = u;
        mm_per_voxel_ = glm::length(view_.geometry.index_to_world_axes * u);
        if (!enter(length_)) return sum_;
        // One probe before the beginning and one behind the end, to find extrema near both.
        const int steps = static_cast<int>(std::ceil(length_ / kStep));
        const double step = length_ / steps;
        std::array<Probe, 3> last{probe(-step), probe(0), probe(step)};
        Extrema before = extrema(last);
        for (int i = 1; i <= steps; ++i) {
            const Probe next = probe((i + 1) * step);
            last = {last[1], last[2], next};
            const Extrema after = extrema(last);
            stretch(last[0], last[1], before, after);
            if (sum_.transmittance < cut_) break;
            before = after;
        }
        // Bound on what lies behind.
        if (sum_.transmittance < cut_) sum_.error += sum_.transmittance;
        return sum_;
    }

  private:
    /// The extrema of value and distance between the outer two of three probes, if any.
    using Extrema = std::array<std::optional<Probe>, 2>;

    /// Finds the part of the ray inside the data, which end half a voxel beyond the outermost centres: there the
    /// voxels' cells end, and the sum of kernels passes one half. False: the ray misses them.
    bool enter(double& length) {
        const glm::dvec3 low(-0.5);
        const glm::dvec3 high = glm::dvec3(view_.geometry.dims) - 0.5;
        double begin = 0;
        double end = std::numeric_limits<double>::infinity();
        for (int axis = 0; axis < 3; ++axis) {
            const double at = view_.eye_index[axis];
            if (u_[axis] == 0) {
                if (!(at >= low[axis] && at <= high[axis])) return false;
                continue;
            }
            const double a = (low[axis] - at) / u_[axis];
            const double b = (high[axis] - at) / u_[axis];
            begin = std::max(begin, std::min(a, b));
            end = std::min(end, std::max(a, b));
        }
        if (!(begin < end)) return false;
        origin_ = view_.eye_index + begin * u_;
        length = end - begin;
        return true;
    }

    Probe probe(double t) {
        const glm::dvec3 x = origin_ + t * u_;
        Probe p{t, scene_.value(x), scene_.signed_distance ? scene_.signed_distance(x) : 0.0, 0};
        const auto above = std::upper_bound(look_.iso_values.begin(), look_.iso_values.end(), p.value);
        p.material = static_cast<int>(above - look_.iso_values.begin());
        if (scene_.without_data && scene_.without_data(x)) p.material = kNoMatter;
        ++sum_.samples;
        return p;
    }

    Extrema extrema(const std::array<Probe, 3>& p) {
        Extrema found;
        if (p[0].material != p[1].material || p[1].material != p[2].material) return found;
        // A ray touches a surface between two probes only if the value there is as near to the iso-value as it changes
        // between probes. A distance changes by at most the step.
        const double change = std::abs(p[1].value - p[0].value) + std::abs(p[2].value - p[1].value);
        const bool near = std::any_of(look_.iso_values.begin(), look_.iso_values.end(),
                                      [&](double iso) { return std::abs(iso - p[1].value) <= change; });
        if (near) found[0] = extremum(p, &Probe::value);
        if (scene_.signed_distance && std::abs(p[1].distance) <= p[2].t - p[0].t)
            found[1] = extremum(p, &Probe::distance);
        return found;
    }

    /// Golden section search. Stops at the first probe in another material; bisection does the rest.
    std::optional<Probe> extremum(const std::array<Probe, 3>& p, double Probe::*of) {
        const auto [low, high] = std::minmax(p[0].*of, p[2].*of);
        double sign = 0;
        if (p[1].*of >= high && p[1].*of > low) sign = 1;
        if (p[1].*of <= low && p[1].*of < high) sign = -1;
        if (sign == 0) return std::nullopt;
        constexpr double kGolden = 0.3819660112501051;
        double begin = p[0].t;
        double end = p[2].t;
        Probe a = probe(begin + kGolden * (end - begin));
        Probe b = probe(end - kGolden * (end - begin));
        while (end - begin > kFinestProbe) {
            if (a.material != p[1].material) return a;
            if (b.material != p[1].material) return b;
            if (sign * a.*of > sign * b.*of) {
                end = b.t;
                b = a;
                a = probe(begin + kGolden * (end - begin));
            } else {
                begin = a.t;
                a = b;
                b = probe(end - kGolden * (end - begin));
            }
        }
        return std::nullopt;
    }

    /// Integrates from one probe to the next, through the extrema between them.
    void stretch(const Probe& from, const Probe& to, const Extrema& before, const Extrema& after) {
        std::array<Probe, 5> at;
        std::size_t count = 0;
        for (const Extrema* extrema : {&before, &after})
            for (const std::optional<Probe>& e : *extrema)
                if (e && e->t > from.t && e->t < to.t) at[count++] = *e;
        std::sort(at.begin(), at.begin() + static_cast<std::ptrdiff_t>(count),
                  [](const Probe& a, const Probe& b) { return a.t < b.t; });
        at[count++] = to;
        Probe p = from;
        for (std::size_t i = 0; i < count; p = at[i++])
            crossings(p, at[i]);
    }

    void crossings(Probe from, const Probe& to) {
        while (from.material != to.material) {
            Probe in = from;
            Probe out = to;
            const double fine = std::max(1e-12, std::min(kFinestProbe, tolerance_ * 1e-3 / fastest()));
            for (int i = 0; i < kDeepestHalving && out.t - in.t > fine; ++i) {
                const Probe middle = probe((in.t + out.t) / 2);
                (middle.material == from.material ? in : out) = middle;
            }
            absorb(from.t, out.t, from.material);
            from = out;
        }
        absorb(from.t, to.t, from.material);
    }

    /// Largest extinction per voxel along this ray.
    double fastest() const {
        double most = 1e-300;
        for (std::size_t m = 0; m < look_.materials.size(); ++m)
            most = std::max(most, extinctions_of(look_, m).most * mm_per_voxel_);
        return most;
    }

    void absorb(double begin, double end, int material) {
        if (!(end > begin) || material == kNoMatter) return;
        if (!look_.transfer.empty()) return absorb_by_value(begin, end);
        const Material& m = look_.materials[static_cast<std::size_t>(material)];
        const double per_voxel = m.extinction * mm_per_voxel_;
        if (!(per_voxel > 0)) return;
        const double tau = per_voxel * (end - begin);
        const double opacity = -std::expm1(-tau);
        // Integrated over opacity instead of length, every point has the same weight; only the light varies.
        const auto color = [&](double a) {
            const double t = std::min(begin - std::log1p(-a) / per_voxel, end);
            ++sum_.samples;
            return color_at(m.color, origin_ + t * u_);
        };
        const glm::dvec3 whole = mean(color, 0, opacity);
        halved(color, 0, opacity, whole, 0);
        sum_.tau += tau;
        sum_.transmittance *= std::exp(-tau);
    }

    /// With a transfer function extinction varies along the ray, too.
    void absorb_by_value(double begin, double end) {
        const auto density = [&](double t) -> Density {
            const glm::dvec3 x = origin_ + t * u_;
            const TransferPoint at = transfer_at(look_.transfer, scene_.value(x));
            const double extinction = at.extinction * mm_per_voxel_;
            return {extinction, extinction > 0 ? extinction * color_at(at.color, x) : glm::dvec3(0)};
        };
        PanelIntegrator(density, {tolerance_, length_}, sum_).add(begin, end - begin);
    }

    template <typename Color>
    static glm::dvec3 mean(const Color& color, double begin, double end) {
        const CollocationRule& rule = collocation_rule();
        glm::dvec3 sum(0);
        for (std::size_t i = 0; i < CollocationRule::kNodes; ++i)
            sum += rule.weights[i] * color(begin + (end - begin) * rule.nodes[i]);
        return (end - begin) * sum;
    }

    template <typename Color>
    void halved(const Color& color, double begin, double end, const glm::dvec3& whole, int depth) {
        const double middle = (begin + end) / 2;
        const glm::dvec3 near = mean(color, begin, middle);
        const glm::dvec3 far = mean(color, middle, end);
        const glm::dvec3 change = glm::abs(near + far - whole);
        const double largest = sum_.transmittance * std::max({change.x, change.y, change.z});
        if (largest <= tolerance_ * sum_.transmittance * (end - begin) || depth >= kDeepestPanel) {
            sum_.color += sum_.transmittance * (near + far);
            sum_.error += largest;
            return;
        }
        halved(color, begin, middle, near, depth + 1);
        halved(color, middle, end, far, depth + 1);
    }

    glm::dvec3 color_at(const glm::dvec3& color, const glm::dvec3& x) const {
        if (look_.lights.empty()) return color;
        // The normal points to lower values, against the gradient. The slope of a distance has the same direction all
        // the way from its edge, so it can be taken at x. It also exists where a step has no gradient.
        glm::dvec3 n = scene_.signed_distance ? distance_slope(x) : -scene_.gradient(x);
        const double length = glm::length(n);
        n = length > 0 && std::isfinite(length) ? n / length : glm::dvec3(0);
        const Border border = border_beside(x);
        if (border.distance < distance_to_surface(x, length)) n = border.normal;
        if (n != glm::dvec3(0)) n = glm::normalize(glm::transpose(view_.world_to_index) * n);
        return lit(look_, {.color = color, .normal = n, .position = view_.geometry.to_world(x)}, view_.frame.eye);
    }

    struct Border {
        double distance = std::numeric_limits<double>::infinity();
        glm::dvec3 normal{0};  ///< out of the volume
    };

    /// The nearest border of the data. Where it cuts matter it is a surface.
    Border border_beside(const glm::dvec3& x) const {
        Border nearest;
        for (int axis = 0; axis < 3; ++axis) {
            const double below = x[axis] + 0.5, above = view_.geometry.dims[axis] - 0.5 - x[axis];
            if (std::min(below, above) >= nearest.distance) continue;
            nearest = {std::min(below, above), glm::dvec3(0)};
            nearest.normal[axis] = below < above ? -1 : 1;
        }
        return nearest;
    }

    /// Distance to the nearest iso-surface, voxels. `slope`: length of the gradient, used if the scene has no distance.
    double distance_to_surface(const glm::dvec3& x, double slope) const {
        double nearest =
            look_.transfer.empty() ? std::numeric_limits<double>::infinity() : double{shader::BORDER_LIGHT};
        if (scene_.signed_distance) return std::min(nearest, std::abs(scene_.signed_distance(x)));
        for (const double iso : look_.iso_values)
            nearest = std::min(nearest, std::abs(scene_.value(x) - iso) / slope);
        return nearest;
    }

    glm::dvec3 distance_slope(const glm::dvec3& x) const {
        glm::dvec3 slope(0);
        for (int axis = 0; axis < 3; ++axis) {
            glm::dvec3 step(0);
            step[axis] = kSlopeStep;
            slope[axis] = scene_.signed_distance(x + step) - scene_.signed_distance(x - step);
        }
        // Half-way between two edges the slope is only rounding error.
        return glm::length(slope) > kSlopeStep * 1e-6 ? slope : glm::dvec3(0);
    }

    const AnalyticScene& scene_;
    const Scene& look_;
    const View& view_;
    double cut_, tolerance_;
    glm::dvec3 u_{0}, origin_{0};
    double length_ = 0;  ///< of the ray within the volume
    double mm_per_voxel_ = 1;
    RaySum sum_;
};

}  // namespace

DirectResult truth(const AnalyticScene& scene, const VolumeGeometry& geometry, const Scene& look, const Camera& camera,
                   int width, int height, const DirectOptions& options) {
    check_picture_size(width, height);
    check_options(options);
    validate(look);
    Scene one_sample = look;
    one_sample.effects.samples = 1;
    if (const std::string obstacle = raycast_obstacle(one_sample); !obstacle.empty())
        fail("truth: {} is not supported, expected a scene without it", obstacle);
    if (geometry.dims != scene.dims) {
        fail("truth: {} has {} x {} x {} voxels, but the volume {} x {} x {}", scene.name, scene.dims.x, scene.dims.y,
             scene.dims.z, geometry.dims.x, geometry.dims.y, geometry.dims.z);
    }
    const auto draw = [&](const View& view, const DirectOptions& how) -> DirectResult {
        const RayFrame frame = trace_rays(width, height, RayValue::Opacity, how.progress, [&]() -> RayTracer {
            return [&view, walker = TruthWalker(scene, look, view, how.tolerance)](int x, int y) mutable {
                return walker.walk(view.ray(x, y));
            };
        });
        return {resolve_color(frame.pixels, width, height, look.background), frame.error, frame.samples};
    };
    return mean_of_samples(View(camera, geometry, width, height), look.effects.samples, options, draw);
}

}  // namespace edgesplat::reference

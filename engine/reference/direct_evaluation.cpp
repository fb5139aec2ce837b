#include "engine/reference/direct_evaluation.h"

#include <algorithm>
#include <cmath>

#include "engine/reference/7_resolve.h"
#include "engine/reference/splat_cloud.h"

namespace edgesplat::reference {

namespace {

constexpr double kPanel = 0.5;  ///< voxels: the coarsest panels, and how far splats are gathered at a time

/// Integrates one ray after the other; one per row.
class RayWalker {
  public:
    RayWalker(const SplatCloud& cloud, const Footprints& footprints, double tolerance, bool tau_only)
        : cloud_(cloud), footprints_(footprints), tolerance_(tolerance), tau_only_(tau_only) {}

    /// `mm_per_voxel` along the unit direction u; both in index space.
    RaySum walk(const glm::dvec3& eye, const glm::dvec3& u, double mm_per_voxel) {
        RaySum sum;
        double begin = 0;
        double end = 0;
        if (!cloud_.clip(eye, u, begin, end)) return sum;
        // Counted from where the ray enters, t stays small, however far away the eye is.
        const glm::dvec3 origin = eye + begin * u;
        const double length = end - begin;
        const double cut = tolerance_ / 10;
        const Accuracy accuracy{tolerance_ - cut, length, tau_only_};
        const auto density = [&](double t) {
            const glm::dvec3 p = origin + t * u;
            Density at;
            for (const ModelSplat* splat : active_) {
                const glm::dvec3 d = p - splat->support_center;
                if (glm::dot(d, d) >= splat->support_radius * splat->support_radius) continue;
                const double h = mm_per_voxel * footprints_.at_point(*splat->edge, p - splat->center);
                at.extinction += h * splat->extinction;
                at.emission += h * splat->emission;
            }
            return at;
        };
        PanelIntegrator integrator(density, accuracy, sum);
        for (double t = 0; t < length;) {
            const double empty = cloud_.empty_around(origin + t * u);
            if (empty > 0) {
                t += std::max(empty, 1e-3);
                continue;
            }
            const double step = std::min(kPanel, length - t);
            cloud_.gather(origin + t * u, origin + (t + step) * u, active_);
            if (!active_.empty()) integrator.add(t, step);
            t += kPanel;
            if (!tau_only_ && sum.transmittance < cut) {
                sum.error += sum.transmittance;  // whatever stands behind
                break;
            }
        }
        if (tau_only_) {
            sum.error /= std::max(sum.tau, 1.0);
            sum.color = glm::dvec3(0);
        }
        return sum;
    }

  private:
    const SplatCloud& cloud_;
    const Footprints& footprints_;
    double tolerance_;
    bool tau_only_;
    std::vector<const ModelSplat*> active_;
};

}  // namespace

Settings without_tables(Settings settings) {
    const bool tabled = settings.footprints == FootprintMode::Table || settings.footprints == FootprintMode::TableLerp;
    if (tabled) settings.footprints = FootprintMode::Procedural;
    return settings;
}

void check_options(const DirectOptions& options) {
    if (!(options.tolerance > 0 && options.tolerance <= 0.1)) {
        fail("tolerance: {} is not above 0 and at most 0.1", options.tolerance);
    }
}

DirectResult direct_evaluation(const PreparedVolume& prepared, const Camera& camera, int width, int height,
                               Output output, const DirectOptions& options) {
    check_picture_size(width, height);
    check_options(options);
    if (output != Output::Color && output != Output::Tau) fail("direct evaluation gives colour or tau only");
    const VolumeGeometry& geometry = prepared.volume().geometry;
    const View view(camera, geometry, width, height);
    const Footprints footprints(without_tables(prepared.settings()));
    const SplatCloud cloud(prepared, view, footprints);

    const RayValue value = output == Output::Tau ? RayValue::Tau : RayValue::Opacity;
    const RayFrame frame = trace_rays(width, height, value, options.progress, [&]() -> RayTracer {
        return
            [&, walker = RayWalker(cloud, footprints, options.tolerance, output == Output::Tau)](int x, int y) mutable {
                const glm::dvec3 u = view.ray(x, y);
                return walker.walk(view.eye_index, u, glm::length(geometry.index_to_world_axes * u));
            };
    });
    return {output == Output::Tau ? resolve_sum(frame.pixels, width, height)
                                  : resolve_color(frame.pixels, width, height, prepared.scene().background),
            frame.error, frame.samples};
}

}  // namespace edgesplat::reference

#include "engine/reference/direct_evaluation.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "engine/image/sample_mean.h"
#include "engine/reference/7_resolve.h"
#include "engine/reference/faces.h"
#include "engine/reference/splat_cloud.h"

namespace edgesplat::reference {

namespace {

constexpr double kPanel = 0.5;  ///< voxels: the coarsest panels, and the segments whose splats are gathered at once

/// Integrates rays one after another. Each row of pixels has its own walker.
class RayWalker {
  public:
    RayWalker(const SplatCloud& cloud, const Footprints& footprints, const PreparedVolume& prepared, const View& view,
              double tolerance, bool tau_only)
        : cloud_(cloud),
          footprints_(footprints),
          scene_(prepared.scene()),
          view_(view),
          clip_(index_clip(prepared.scene().effects.clip, view.geometry)),
          prepared_(prepared),
          tolerance_(tolerance),
          tau_only_(tau_only) {}

    /// u: unit direction; `mm_per_voxel`: mm per voxel along u. Both in index space.
    RaySum walk(const glm::dvec3& eye, const glm::dvec3& u, double mm_per_voxel) {
        RaySum sum;
        double begin = 0;
        double end = 0;
        if (!cloud_.clip(eye, u, begin, end)) return sum;
        if (draws_faces(prepared_.settings())) {
            const VolumePiece inside = piece_in_volume(view_.geometry.dims, eye, u);
            begin = std::max(begin, inside.low);
            end = std::min(end, inside.high);
            if (!(begin < end)) return sum;
        }
        // t counts from where the ray enters: it stays small even for a far eye.
        const glm::dvec3 origin = eye + begin * u;
        const double length = end - begin;
        const double cut = tolerance_ / 10;
        const Accuracy accuracy{tolerance_ - cut, length, tau_only_};
        const auto density = [&](double t) {
            const glm::dvec3 p = origin + t * u;
            Density at;
            for (std::size_t i = 0; i < active_.size(); ++i) {
                const ModelSplat* splat = active_[i];
                const glm::dvec3 d = p - splat->center;
                if (glm::dot(d, d) >= splat->reach * splat->reach) continue;
                const double h = mm_per_voxel * (paths_[i] ? paths_[i]->kernel_at(glm::dot(p - splat->center, u))
                                                           : footprints_.at_point(*splat->edge, p - splat->center));
                at.extinction += h * splat->extinction;
                at.emission += h * emission_[i];
            }
            return at;
        };
        PanelIntegrator integrator(density, accuracy, sum);
        for (const KeptPiece& piece : clip_.kept_along(origin, u)) {
            const double last = std::min(piece.last, length);
            // A cut shows only if it lies in front of the eye.
            const bool cut_seen = piece.face && piece.first > -begin;
            for (double t = std::max(piece.first, 0.0); t < last && (tau_only_ || sum.transmittance >= cut);) {
                const double empty = cloud_.empty_distance(origin + t * u);
                if (empty > 0) {
                    t += std::max(empty, 1e-3);
                    continue;
                }
                const double step = std::min(kPanel, last - t);
                cloud_.gather(origin + t * u, origin + (t + step) * u, active_);
                light(cut_seen ? piece.face : std::nullopt, origin + (cut_seen ? piece.first : 0) * u, u);
                if (!active_.empty()) add_pieces(integrator, origin, u, t, t + step);
                t += kPanel;
            }
        }
        if (!tau_only_ && sum.transmittance < cut) sum.error += sum.transmittance;  // bound on what lies behind
        if (tau_only_) {
            sum.error /= std::max(sum.tau, 1.0);
            sum.color = glm::dvec3(0);
        }
        return sum;
    }

  private:
    /// Integrates from `begin` to `end`, in panels that end where a face's piece begins, ends or changes how a kernel
    /// is moved.
    template <typename Integrator>
    void add_pieces(Integrator& integrator, const glm::dvec3& origin, const glm::dvec3& u, double begin, double end) {
        breaks_.assign({begin, end});
        for (std::size_t i = 0; i < active_.size(); ++i) {
            if (!paths_[i]) continue;
            const double center = glm::dot(active_[i]->center - origin, u);
            const auto add = [&](double z) {
                if (center + z > begin && center + z < end) breaks_.push_back(center + z);
            };
            for (const FacePiece& piece : paths_[i]->pieces())
                for (const double z : {piece.low, 0.5 * (piece.low + piece.high), piece.high})
                    add(z);
            for (const double z : {-paths_[i]->half_chord(), paths_[i]->half_chord()})
                add(z);
        }
        std::ranges::sort(breaks_);
        for (std::size_t i = 1; i < breaks_.size(); ++i)
            if (breaks_[i] - breaks_[i - 1] > 1e-9) integrator.add(breaks_[i - 1], breaks_[i] - breaks_[i - 1]);
    }

    /// Sets paths and emission of the gathered splats along the ray through `entry`. `face`: the normal if the ray
    /// begins there in a cut.
    void light(const std::optional<glm::dvec3>& face, const glm::dvec3& entry, const glm::dvec3& u) {
        emission_.clear();
        paths_.clear();
        for (const ModelSplat* splat : active_) {
            const glm::dvec3 off = entry - splat->center;
            const double along = glm::dot(off, u);
            const glm::dvec3 p = off - along * u;
            const bool shows_cut = face && footprints_.in_matter(*splat->edge, p, u, along);
            emission_.push_back(shows_cut ? splat->extinction * cap_payload(splat->record, glm::dvec3(0), *face, entry,
                                                                            scene_, view_, Payload::Color)
                                          : splat->extinction * own_light(*splat, p, u));
            paths_.emplace_back();
            if (!footprints_.cuts(*splat->edge)) continue;
            paths_.back().emplace(footprints_.face_path(*splat->edge, p, u));
        }
    }

    /// A face is lit where the ray meets it. So all points of the ray have the same light.
    glm::dvec3 own_light(const ModelSplat& splat, const glm::dvec3& p, const glm::dvec3& u) const {
        if (tau_only_ || !draws_faces(prepared_.settings())) return splat.emission / splat.extinction;
        return face_payload(splat.record, prepared_.field(), scene_, view_, prepared_.settings(), Payload::Color,
                            footprints_, p, u);
    }

    const SplatCloud& cloud_;
    const Footprints& footprints_;
    const Scene& scene_;
    const View& view_;
    IndexClip clip_;
    const PreparedVolume& prepared_;
    double tolerance_;
    bool tau_only_;
    std::vector<const ModelSplat*> active_;
    std::vector<glm::dvec3> emission_;  ///< per active splat
    std::vector<double> breaks_;
    std::vector<std::optional<FacePath>> paths_;  ///< per active splat: set if a face cuts its kernel
};

}  // namespace

void check_options(const DirectOptions& options) {
    if (!(options.tolerance > 0 && options.tolerance <= 0.1)) {
        fail("tolerance: {} is out of range, expected above 0 and at most 0.1", options.tolerance);
    }
}

DirectResult mean_of_samples(View view, int n, const DirectOptions& options,
                             const std::function<DirectResult(const View&, const DirectOptions&)>& draw) {
    if (n == 1) return draw(view, options);
    const std::vector<glm::dvec2> offsets = sample_offsets(n);
    SampleMean mean({view.width, view.height});
    DirectResult all;
    double before = 0;
    DirectOptions of_one = options;
    if (options.progress)
        of_one.progress = [&](double done) {
            return options.progress((before + done) / static_cast<double>(offsets.size()));
        };
    for (const glm::dvec2& offset : offsets) {
        view.offset = offset;
        const DirectResult one = draw(view, of_one);
        mean.add(one.image.pixels);
        all.error_estimate = std::max(all.error_estimate, one.error_estimate);
        all.samples += one.samples;
        before += 1;
    }
    all.image = mean.image();
    return all;
}

DirectResult direct_evaluation(const PreparedVolume& prepared, const Camera& camera, int width, int height,
                               Output output, const DirectOptions& options) {
    if (!prepared.is_alone())
        fail("volumes: direct evaluation is of one volume, but the scene has several; expected renderer splat");
    check_picture_size(width, height);
    check_options(options);
    if (output != Output::Color && output != Output::Tau) fail("direct evaluation renders only colour or tau");
    const VolumeGeometry& geometry = prepared.volume().geometry;
    const Footprints& footprints = prepared.footprints();
    const bool tau = output == Output::Tau;
    const auto draw = [&](const View& view, const DirectOptions& how) -> DirectResult {
        const SplatCloud cloud(prepared, view, footprints);
        const RayValue value = tau ? RayValue::Tau : RayValue::Opacity;
        const RayFrame frame = trace_rays(width, height, value, how.progress, [&]() -> RayTracer {
            return
                [&, walker = RayWalker(cloud, footprints, prepared, view, how.tolerance, tau)](int x, int y) mutable {
                    const glm::dvec3 u = view.ray(x, y);
                    return walker.walk(view.eye_index, u, glm::length(geometry.index_to_world_axes * u));
                };
        });
        return {tau ? resolve_sum(frame.pixels, width, height)
                    : resolve_color(frame.pixels, width, height, prepared.scene().background,
                                    prepared.scene().effects.background_top),
                frame.error, frame.samples};
    };
    return mean_of_samples(View(camera, geometry, width, height), tau ? 1 : prepared.scene().effects.samples, options,
                           draw);
}

}  // namespace edgesplat::reference

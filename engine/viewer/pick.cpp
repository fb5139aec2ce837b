#include "engine/viewer/pick.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/error.h"
#include "engine/scene/clip_planes.h"
#include "engine/scene/transfer_function.h"
#include "engine/viewer/contour.h"

namespace edgesplat::viewer {
namespace {

/// The kind of surface through which the ray entered its current matter.
enum class Entry { Eye, Plane, Side, Contour, Gradual };

struct Surface {
    Entry entry = Entry::Gradual;
    double t = 0;          ///< mm
    glm::dvec3 normal{0};  ///< index space; of planes and sides
    double value = 0;
    int material = 0;
};

/// A part of the ray that is inside the volume and not clipped.
struct Stretch {
    double first = 0, last = 0;
    Entry entry = Entry::Side;
    glm::dvec3 normal{0};  ///< index space
};

/// A cubic over w in [0, 1] through its values at 0, 1/3, 2/3 and 1.
struct Cubic {
    double a, b, c, d;  ///< a + b w + c w^2 + d w^3
    Cubic(double v0, double v1, double v2, double v3)
        : a(v0),
          b((-11 * v0 + 18 * v1 - 9 * v2 + 2 * v3) / 2),
          c((18 * v0 - 45 * v1 + 36 * v2 - 9 * v3) / 2),
          d((-9 * v0 + 27 * v1 - 27 * v2 + 9 * v3) / 2) {}
    double operator()(double w) const { return a + w * (b + w * (c + w * d)); }
    /// Roots of the derivative in (0, 1), ascending; the cubic is monotonic between them.
    std::vector<double> turns() const {
        std::vector<double> roots;
        const auto add = [&](double w) {
            if (w > 0 && w < 1) roots.push_back(w);
        };
        const double half = c, square = half * half - 3 * d * b;
        if (std::abs(d) > 0 && square >= 0) {
            const double q = -(half + std::copysign(std::sqrt(square), half));
            add(q / (3 * d));
            if (q != 0) add(b / q);
        } else if (d == 0 && c != 0) {
            add(-b / (2 * c));
        }
        std::sort(roots.begin(), roots.end());
        return roots;
    }
};

class March {
  public:
    March(const Samples& samples, const Scene& scene, const IndexRay& ray, double opacity)
        : samples_(samples), scene_(scene), ray_(ray) {
        solid_from_ = std::log(2.0) / samples.volume().geometry.mean_spacing();
        targets_ = {-std::log1p(-opacity / 2), -std::log1p(-opacity), -std::log((1 - opacity) / 2)};
        cuts_ = scene.iso_values;
        for (const TransferPoint& point : scene.transfer)
            cuts_.push_back(point.value);
        std::sort(cuts_.begin(), cuts_.end());
        const Volume& volume = samples.volume();
        if (draws_missing_samples(scene, volume))
            missing_from_ =
                static_cast<int>((scene.transfer.empty() ? std::ranges::upper_bound(
                                                               scene.iso_values, static_cast<double>(volume.min_value))
                                                         : scene.iso_values.end()) -
                                 scene.iso_values.begin());
    }

    /// Marches along a stretch. Returns true if the rest of the ray is not needed.
    bool add(const Stretch& stretch) {
        solid_ = false;
        start_ = &stretch;
        double t = stretch.first;
        while (t < stretch.last) {
            // Up to the next plane through voxel centres.
            double next = stretch.last;
            const glm::dvec3 ahead = ray_.at(t);
            for (int axis = 0; axis < 3; ++axis) {
                const double step = ray_.step[axis];
                if (step == 0) continue;
                const double at = step > 0 ? std::floor(ahead[axis] + 1e-9) + 1 : std::ceil(ahead[axis] - 1e-9) - 1;
                const double there = (at - ray_.origin[axis]) / step;
                if (there > t) next = std::min(next, there);
            }
            if (add_cell(t, next)) return true;
            t = next;
        }
        return false;
    }

    const std::optional<Surface>& hit() const { return hit_; }
    /// Distance between the opacities halfway to `opacity` and halfway from it to 1.
    double spread() const { return std::min(reached_[2], last_matter_) - reached_[0]; }

  private:
    double extinction(double value, int material) const {
        return scene_.transfer.empty() ? scene_.materials[static_cast<std::size_t>(material)].extinction
                                       : transfer_at(scene_.transfer, value).extinction;
    }

    bool add_cell(double first, double last) {
        const auto value = [&](double w) { return samples_.linear(ray_.at(std::lerp(first, last, w))); };
        const Cubic f(value(0), value(1.0 / 3), value(2.0 / 3), value(1));
        std::vector<double> turns = f.turns();
        turns.push_back(1);
        double from = 0;
        for (const double to : turns) {
            // Cuts (iso-values, transfer points) between both values, in order along the ray.
            const double a = f(from), b = f(to);
            const auto low = std::upper_bound(cuts_.begin(), cuts_.end(), std::min(a, b));
            const auto high = std::lower_bound(low, cuts_.end(), std::max(a, b));
            std::vector<double> places;
            for (auto cut = low; cut != high; ++cut)
                places.push_back(bisected([&](double w) { return f(w) - *cut; }, from, to));
            std::sort(places.begin(), places.end());
            places.push_back(to);
            for (const double place : places) {
                if (add_piece(f, first, last, from, place)) return true;
                from = place;
            }
        }
        return false;
    }

    /// Adds a piece between two cuts, where extinction is constant or linear in the value.
    bool add_piece(const Cubic& f, double first, double last, double from, double to) {
        if (!(to > from)) return false;
        const double middle_value = f((from + to) / 2), begin = std::lerp(first, last, from);
        const auto material =
            static_cast<int>(std::upper_bound(scene_.iso_values.begin(), scene_.iso_values.end(), middle_value) -
                             scene_.iso_values.begin());
        const auto sigma = [&](double w) { return extinction(f(w), material); };
        // Matter of the smallest value is not there where samples contain no data.
        if (missing_from_ >= material && is_missing(ray_.at((begin + std::lerp(first, last, to)) / 2))) {
            solid_ = false;
            return false;
        }
        const bool solid = sigma((from + to) / 2) >= solid_from_;
        if (solid && !solid_) {
            const bool at_start = begin == start_->first;
            entry_ = {at_start                  ? start_->entry
                      : scene_.transfer.empty() ? Entry::Contour
                                                : Entry::Gradual,
                      begin, start_->normal, f(from), material};
        }
        solid_ = solid;
        // Simpson's rule is exact for cubics.
        const auto tau_to = [&](double w) {
            return (w - from) * (last - first) * (sigma(from) + 4 * sigma((from + w) / 2) + sigma(w)) / 6;
        };
        const double tau = tau_to(to);
        if (tau > 0) last_matter_ = std::lerp(first, last, to);
        while (next_ < targets_.size() && tau_ + tau >= targets_[next_]) {
            const double w = bisected([&](double x) { return tau_ + tau_to(x) - targets_[next_]; }, from, to);
            const double t = std::lerp(first, last, w);
            reached_[next_] = t;
            if (next_++ != 1) continue;
            hit_ = solid && entry_.entry != Entry::Gradual ? entry_ : Surface{Entry::Gradual, t, {}, f(w), material};
            if (hit_->entry != Entry::Gradual) return true;
        }
        tau_ += tau;
        return next_ == targets_.size();
    }

    bool is_missing(const glm::dvec3& voxel) const {
        const Volume& volume = samples_.volume();
        return !volume.has_data(glm::clamp(glm::ivec3(glm::round(voxel)), glm::ivec3(0), volume.geometry.dims - 1));
    }

    const Samples& samples_;
    const Scene& scene_;
    IndexRay ray_;
    int missing_from_ = -1;  ///< the highest material that may be missing; -1: none
    double solid_from_ = 0;  ///< extinction per mm
    std::vector<double> cuts_;
    std::array<double, 3> targets_{}, reached_{kInfinity, kInfinity, kInfinity};
    std::size_t next_ = 0;
    double tau_ = 0, last_matter_ = 0;
    const Stretch* start_ = nullptr;
    bool solid_ = false;
    Surface entry_;
    std::optional<Surface> hit_;
};

/// The parts of the ray that are inside the volume and not clipped, nearest first.
std::vector<Stretch> stretches(const Volume& volume, const Scene& scene, const IndexRay& ray) {
    const glm::dvec3 low(-0.5), high = glm::dvec3(volume.geometry.dims) - 0.5;
    Stretch whole{0, kInfinity, Entry::Eye, {}};
    for (int axis = 0; axis < 3; ++axis) {
        const double step = ray.step[axis], from = ray.origin[axis];
        if (step == 0) {
            if (from < low[axis] || from > high[axis]) return {};
            continue;
        }
        const double first = ((step > 0 ? low : high)[axis] - from) / step;
        const double last = ((step > 0 ? high : low)[axis] - from) / step;
        if (first > whole.first) {
            whole.first = first;
            whole.entry = Entry::Side;
            whole.normal = glm::dvec3(0);
            whole.normal[axis] = step > 0 ? -1 : 1;
        }
        whole.last = std::min(whole.last, last);
    }
    const double length = glm::length(ray.step);
    const IndexClip clip = index_clip(scene.effects.clip, volume.geometry);
    std::vector<Stretch> out;
    for (const KeptPiece& piece : clip.kept_along(ray.origin, ray.step / length)) {
        Stretch s = whole;
        s.last = std::min(s.last, piece.last / length);
        if (piece.first / length > s.first) {
            s.first = piece.first / length;
            s.entry = Entry::Plane;
            s.normal = piece.face.value_or(glm::dvec3(0));
        }
        if (s.first < s.last) out.push_back(s);
    }
    return out;
}

}  // namespace

const Volume& volume_of(const Volume& first, const Scene& scene, std::size_t number) {
    return number == 0 || number > scene.added.size() ? first : *scene.added[number - 1].volume;
}

std::vector<ValueThere> values_at(const Volume& volume, const Scene& scene, const glm::dvec3& place) {
    std::vector<ValueThere> values;
    for (std::size_t number = 0; number <= scene.added.size(); ++number) {
        const Volume& one = volume_of(volume, scene, number);
        const glm::dvec3 voxel = one.geometry.to_index(place), last(one.geometry.dims - 1);
        if (!glm::all(glm::greaterThanEqual(voxel, glm::dvec3(-0.5))) ||
            !glm::all(glm::lessThanEqual(voxel, last + 0.5)))
            continue;
        values.push_back({number, voxel, interpolated(one, voxel)});
    }
    return values;
}

std::optional<Pick> pick(const Volume& volume, const Scene& scene, const Ray& world_ray, double opacity) {
    if (!scene.added.empty()) {
        validate(scene);
        std::optional<Pick> nearest;
        for (std::size_t number = 0; number <= scene.added.size(); ++number) {
            const Scene one = scene_of_volume(scene, number);
            if (!has_matter(one)) continue;
            const auto found = pick(volume_of(volume, scene, number), one, world_ray, opacity);
            if (!found || (nearest && nearest->distance <= found->distance)) continue;
            nearest = found;
            nearest->number = number;
        }
        return nearest;
    }
    if (!(opacity > 0 && opacity < 1)) fail("pick opacity: {}, expected a number between 0 and 1", opacity);
    validate(scene);
    const VolumeGeometry& geometry = volume.geometry;
    const glm::dmat3 to_index = glm::inverse(geometry.index_to_world_axes);
    const IndexRay ray{to_index * (world_ray.origin - geometry.origin), to_index * world_ray.direction};
    if (!std::isfinite(glm::dot(ray.origin, ray.origin)) || !std::isfinite(glm::dot(ray.step, ray.step)))
        return std::nullopt;
    const Samples samples(volume);
    March march(samples, scene, ray, opacity);
    for (const Stretch& stretch : stretches(volume, scene, ray))
        if (march.add(stretch)) break;
    if (!march.hit()) return std::nullopt;

    const Surface& hit = *march.hit();
    const double voxel = 1 / glm::length(ray.step);
    Pick result;
    result.voxel = ray.at(hit.t);
    result.world = world_ray.at(hit.t);
    result.value = hit.value;
    result.distance = hit.t;
    result.material = hit.material;
    const bool face = hit.entry == Entry::Plane || hit.entry == Entry::Side;
    glm::dvec3 normal = glm::transpose(to_index) * (face ? hit.normal : samples.gradient(result.voxel));
    if (!(glm::length(normal) > 0)) normal = -world_ray.direction;
    normal = glm::normalize(normal);
    result.normal = glm::dot(normal, world_ray.direction) > 0 ? -normal : normal;
    if (hit.entry == Entry::Side) result.uncertainty = voxel / 2;
    if (hit.entry == Entry::Gradual) result.uncertainty = march.spread();
    if (hit.entry == Entry::Contour) result.uncertainty = contour_uncertainty(samples, ray, hit.t, hit.value);
    return result;
}

std::optional<Pick> pick(const Volume& volume, const Scene& scene, const Camera& camera, const glm::ivec2& size,
                         const glm::dvec2& pixel, double opacity) {
    return pick(volume, scene, pixel_ray(camera, size, pixel), opacity);
}

}  // namespace edgesplat::viewer

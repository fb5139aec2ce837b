#include "engine/accuracy/report_cameras.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/reference/field.h"
#include "engine/scene/views.h"

namespace edgesplat::accuracy {
namespace {

constexpr double kStep = 0.25;        ///< voxels: step of a ray that searches for a surface
constexpr double kClearance = 1.5;    ///< voxels without matter around an eye
constexpr double kCavityShare = 0.6;  ///< share of directions from a place in a cavity that meet matter

/// Finds the visible matter of a volume.
class Matter {
  public:
    Matter(const Volume& volume, const Scene& scene)
        : volume_(volume),
          scene_(scene),
          samples_{volume.geometry.dims, volume.values, {}},
          top_(glm::dvec3(volume.geometry.dims - 1)) {}

    const VolumeGeometry& geometry() const { return volume_.geometry; }
    glm::dvec3 center() const { return top_ / 2.0; }
    double diagonal() const { return glm::length(top_); }

    bool contains(const glm::dvec3& p) const {
        return glm::all(glm::greaterThanEqual(p, glm::dvec3(0))) && glm::all(glm::lessThanEqual(p, top_));
    }
    bool seen(double value) const {
        const auto& isos = scene_.iso_values;
        const auto m = static_cast<std::size_t>(std::upper_bound(isos.begin(), isos.end(), value) - isos.begin());
        return m < scene_.materials.size() && scene_.materials[m].extinction > 0;
    }
    /// Whether p is in matter, by trilinear interpolation; outside the grid it is not.
    bool at(const glm::dvec3& p) const { return contains(p) && seen(reference::sample(samples_, p)); }
    bool voxel(const glm::ivec3& i) const {
        return glm::all(glm::greaterThanEqual(i, glm::ivec3(0))) && glm::all(glm::lessThan(i, geometry().dims)) &&
               seen(static_cast<double>(volume_.at(i.x, i.y, i.z)));
    }
    /// Normal at p, out of the matter.
    glm::dvec3 normal(const glm::dvec3& p) const {
        glm::dvec3 g = reference::point_gradient(samples_, p);
        if (!(glm::length(g) > 0)) return {0, 0, 1};
        g = glm::normalize(g);
        return at(p + 0.5 * g) && !at(p - 0.5 * g) ? -g : (at(p - 0.5 * g) && !at(p + 0.5 * g) ? g : -g);
    }
    /// Whether no voxel of matter lies within `radius` of p.
    bool clear(const glm::dvec3& p, double radius) const {
        const glm::ivec3 low(glm::ceil(p - radius)), high(glm::floor(p + radius));
        for (int z = low.z; z <= high.z; ++z)
            for (int y = low.y; y <= high.y; ++y)
                for (int x = low.x; x <= high.x; ++x) {
                    const glm::ivec3 i(x, y, z);
                    if (voxel(i) && glm::distance(glm::dvec3(i), p) <= radius) return false;
                }
        return !at(p);
    }

  private:
    const Volume& volume_;
    const Scene& scene_;
    reference::Field samples_;
    glm::dvec3 top_;
};

std::optional<SurfaceHit> first_hit(const Matter& matter, const glm::dvec3& origin, const glm::dvec3& u) {
    if (matter.at(origin)) return {};
    const double end = glm::distance(origin, matter.center()) + matter.diagonal();
    for (double t = kStep; t < end; t += kStep) {
        if (!matter.at(origin + t * u)) continue;
        double low = t - kStep, high = t;
        for (int i = 0; i < 40; ++i)
            (matter.at(origin + (low + high) / 2 * u) ? high : low) = (low + high) / 2;
        const glm::dvec3 p = origin + high * u;
        return SurfaceHit{p, matter.normal(p), high};
    }
    return {};
}

/// Of a 15 x 15 raster of rays through the picture, the hit nearest to the picture's middle.
std::optional<SurfaceHit> central_hit(const Matter& matter, const Camera& camera, double aspect) {
    const CameraFrame frame = camera_frame(camera);
    std::vector<glm::dvec2> raster;
    for (int j = -7; j <= 7; ++j)
        for (int i = -7; i <= 7; ++i)
            raster.emplace_back(i / 8.0, j / 8.0);
    std::stable_sort(raster.begin(), raster.end(),
                     [](const glm::dvec2& a, const glm::dvec2& b) { return glm::dot(a, a) < glm::dot(b, b); });
    const glm::dmat3 to_index = glm::inverse(matter.geometry().index_to_world_axes);
    for (const glm::dvec2& s : raster) {
        const glm::dvec3 ray = frame.forward + frame.tan_half_y * (aspect * s.x * frame.right + s.y * frame.up);
        const auto hit = first_hit(matter, matter.geometry().to_index(frame.eye), glm::normalize(to_index * ray));
        if (hit) return hit;
    }
    return {};
}

/// A camera from eye, direction and `up` in index space.
Camera camera_from_index(const Matter& matter, const glm::dvec3& eye, const glm::dvec3& direction, const glm::dvec3& up,
                         double fov) {
    const glm::dmat3& axes = matter.geometry().index_to_world_axes;
    return {matter.geometry().to_world(eye), axes * direction, axes * up, fov};
}

std::array<glm::dvec3, 2> across(const glm::dvec3& n) {
    const glm::dvec3 other = std::abs(n.z) < 0.7 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0);
    const glm::dvec3 a = glm::normalize(glm::cross(n, other));
    return {a, glm::cross(n, a)};
}

/// A camera that looks along the surface at the hit, from as far away as there is room.
std::optional<ReportCamera> grazing_camera(const Matter& matter, const SurfaceHit& hit) {
    const auto [a, b] = across(hit.normal);
    for (const auto& [height, back] : {std::pair{3.0, 12.0}, {3.0, 8.0}, {2.5, 5.0}, {2.0, 4.0}, {1.75, 2.5}}) {
        for (int i = 0; i < 8; ++i) {
            const double angle = i * 3.14159265358979323846 / 4;
            const glm::dvec3 along = std::cos(angle) * a + std::sin(angle) * b;
            const glm::dvec3 eye = hit.position + height * hit.normal - back * along;
            const glm::dvec3 target = hit.position + 2.0 * along;
            if (!matter.clear(eye, kClearance)) continue;
            const auto met = first_hit(matter, eye, glm::normalize(target - eye));
            if (met && met->distance < back - 2) continue;  // other matter occludes the surface
            return ReportCamera{
                "grazing",
                fmt::format("along the surface at voxel {:.1f},{:.1f},{:.1f}, {:.0f} degrees to it", hit.position.x,
                            hit.position.y, hit.position.z, std::atan2(height, back + 2) * 180 / 3.14159265358979),
                camera_from_index(matter, eye, target - eye, hit.normal, 50)};
        }
    }
    return {};
}

/// The 26 directions to the neighbours of a voxel.
std::vector<glm::dvec3> neighbour_directions() {
    std::vector<glm::dvec3> list;
    for (int i = 0; i < 27; ++i)
        if (i != 13) list.push_back(glm::normalize(glm::dvec3(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1)));
    return list;
}

/// Voxels to the first voxel of matter along u; nullopt if the ray leaves the grid first.
std::optional<double> voxels_to_matter(const Matter& matter, const glm::dvec3& from, const glm::dvec3& u) {
    for (double t = 1; matter.contains(from + t * u); t += 1)
        if (matter.voxel(glm::ivec3(glm::round(from + t * u)))) return t;
    return {};
}

/// A camera in the most enclosed cavity, of a raster of at most about 20 000 places; of equals the widest.
std::optional<ReportCamera> cavity_camera(const Matter& matter) {
    const glm::ivec3 dims = matter.geometry().dims;
    const auto stride = std::max(
        1, static_cast<int>(std::ceil(std::cbrt(static_cast<double>(matter.geometry().voxel_count()) / 20000.0))));
    const std::vector<glm::dvec3> directions = neighbour_directions();
    double best_share = 0, best_room = 0;
    glm::dvec3 best(0);
    for (int z = 2; z + 2 < dims.z; z += stride)
        for (int y = 2; y + 2 < dims.y; y += stride)
            for (int x = 2; x + 2 < dims.x; x += stride) {
                const glm::dvec3 p(x, y, z);
                if (!matter.clear(p, kClearance)) continue;
                int hits = 0;
                double room = 1e9;
                for (const glm::dvec3& u : directions)
                    if (const auto t = voxels_to_matter(matter, p, u)) {
                        ++hits;
                        room = std::min(room, *t);
                    }
                const double share = hits / 26.0;
                if (share > best_share || (share == best_share && room > best_room)) {
                    best_share = share;
                    best_room = room;
                    best = p;
                }
            }
    if (best_share < kCavityShare) return {};
    glm::dvec3 view(0, 0, 1);
    double farthest = 0;
    for (const glm::dvec3& u : directions)
        if (const auto t = voxels_to_matter(matter, best, u); t && *t > farthest) {
            farthest = *t;
            view = u;
        }
    return ReportCamera{"inside",
                        fmt::format("from the cavity at voxel {},{},{}; matter in {:.0f} % of the directions", best.x,
                                    best.y, best.z, 100 * best_share),
                        camera_from_index(matter, best, view, across(view)[1], 90)};
}

/// A camera close above the surface, within the grid if possible.
std::optional<ReportCamera> surface_camera(const Matter& matter, const SurfaceHit& hit) {
    const glm::dvec3 along = across(hit.normal)[0];
    for (const bool within : {true, false})
        for (const double height : {3.0, 2.5, 2.0, 1.75}) {
            const glm::dvec3 eye = hit.position + height * hit.normal;
            if ((within && !matter.contains(eye)) || !matter.clear(eye, kClearance)) continue;
            return ReportCamera{"inside", fmt::format("no cavity: {} voxels above the surface", height),
                                camera_from_index(matter, eye, 0.6 * along - hit.normal, hit.normal, 90)};
        }
    return {};
}

}  // namespace

std::optional<SurfaceHit> first_surface(const Volume& volume, const Scene& scene, const glm::dvec3& origin,
                                        const glm::dvec3& u) {
    return first_hit(Matter(volume, scene), origin, u);
}

std::vector<ReportCamera> report_cameras(const Volume& volume, const Scene& scene, int width, int height) {
    const Matter matter(volume, scene);
    const double aspect = static_cast<double>(width) / height;
    const ViewRequest request{&volume, &scene, 35, width, height};
    std::vector<ReportCamera> list;
    list.push_back({"far", "the whole volume, obliquely", named_view("oblique", request)});

    Camera near = named_view("close", request);
    std::optional<SurfaceHit> hit = central_hit(matter, near, aspect);
    const auto clear = [&](const Camera& camera) {
        return matter.clear(matter.geometry().to_index(camera.eye), kClearance);
    };
    if (hit && clear(near)) list.push_back({"near", "the view `close`: a voxel covers 24 pixels", near});
    if (!hit) hit = central_hit(matter, list.front().camera, aspect);
    if (!hit) return list;
    if (auto camera = grazing_camera(matter, *hit)) list.push_back(std::move(*camera));
    auto inside = cavity_camera(matter);
    if (!inside) inside = surface_camera(matter, *hit);
    if (inside) list.push_back(std::move(*inside));
    return list;
}

}  // namespace edgesplat::accuracy

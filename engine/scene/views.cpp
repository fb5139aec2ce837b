#include "engine/scene/views.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <optional>
#include <vector>

#include "engine/error.h"
#include "engine/scene/clip_planes.h"
#include "engine/scene/transfer_function.h"
#include "engine/volume/grid.h"
#include "engine/volume/packed_volume.h"
#include "engine/volume/parallel.h"

namespace edgesplat {
namespace {

constexpr double kMargin = 1.04;             ///< margin around the bounding box
constexpr double kClosePixelsPerVoxel = 24;  ///< pixels per voxel in the `close` view
constexpr double kClearlyBetter = 1.15;      ///< a view must score this factor times front's score to replace it

struct NamedDirection {
    std::string_view name;
    glm::dvec3 direction, up;
};
constexpr std::array<NamedDirection, 8> kViews{{
    {"front", {0, 1, 0}, {0, 0, 1}},
    {"back", {0, -1, 0}, {0, 0, 1}},
    {"left", {-1, 0, 0}, {0, 0, 1}},
    {"right", {1, 0, 0}, {0, 0, 1}},
    {"top", {0, 0, -1}, {0, -1, 0}},
    {"bottom", {0, 0, 1}, {0, -1, 0}},
    {"oblique", {-0.6, 1, -0.5}, {0, 0, 1}},
    {"close", {0, 1, 0}, {0, 0, 1}},
}};
constexpr auto names_of_views() {
    std::array<std::string_view, kViews.size()> names{};
    for (std::size_t i = 0; i < names.size(); ++i)
        names[i] = kViews[i].name;
    return names;
}
constexpr auto kNames = names_of_views();

bool shows(const Scene& scene, double value) {
    if (!scene.transfer.empty()) return transfer_at(scene.transfer, value).extinction > 0;
    const auto above = std::ranges::upper_bound(scene.iso_values, value);
    return scene.materials[static_cast<std::size_t>(above - scene.iso_values.begin())].extinction > 0;
}

/// Points with the same convex hull as the visible boxes of `side` voxels: the first and last box of each row.
std::vector<glm::dvec3> points_of_boxes(const Volume& volume, const Scene& scene, const glm::ivec3& side) {
    const glm::ivec3 ends = volume.geometry.dims - side;
    const IndexClip clip = index_clip(scene.effects.clip, volume.geometry);
    const glm::dvec3 middle = 0.5 * glm::dvec3(side - 1);
    const auto seen = [&](int x, int y, int z) {
        for (int k = z; k < z + side.z; ++k)
            for (int j = y; j < y + side.y; ++j)
                for (int i = x; i < x + side.x; ++i)
                    if (!volume.has_data({i, j, k}) || !shows(scene, static_cast<double>(volume.at(i, j, k))))
                        return false;
        return clip.empty() || !clip.cuts_away(glm::dvec3(x, y, z) + middle);
    };
    std::vector<std::vector<glm::dvec3>> of_slices(static_cast<std::size_t>(std::max(ends.z + 1, 0)));
    parallel_for(ends.z + 1, [&](int begin, int end) {
        for (int z = begin; z < end; ++z)
            for (int y = 0; y <= ends.y; ++y) {
                int first = 0, last = ends.x;
                while (first <= last && !seen(first, y, z))
                    ++first;
                while (last > first && !seen(last, y, z))
                    --last;
                if (first > last) continue;
                std::vector<glm::dvec3>& points = of_slices[static_cast<std::size_t>(z)];
                for (const int far : {0, side.z})
                    for (const int up : {0, side.y}) {
                        points.emplace_back(first - 0.5, y + up - 0.5, z + far - 0.5);
                        points.emplace_back(last + side.x - 0.5, y + up - 0.5, z + far - 0.5);
                    }
            }
    });
    std::vector<glm::dvec3> all;
    for (const std::vector<glm::dvec3>& points : of_slices)
        all.insert(all.end(), points.begin(), points.end());
    return all;
}

/// Points (index space of `volume`) with the same convex hull as the visible matter. Only cubes of eight voxels count,
/// as far as the volume is that thick: single voxels may be noise. If there is no cube, all matter is thin, and single
/// voxels count. Empty if nothing is visible.
std::vector<glm::dvec3> seen_points(const Volume& volume, const Scene& scene) {
    std::vector<glm::dvec3> points = points_of_boxes(volume, scene, glm::min(volume.geometry.dims, glm::ivec3(2)));
    if (points.empty()) points = points_of_boxes(volume, scene, glm::ivec3(1));
    return points;
}

/// Points that must be in the picture, world: the volume's corners, or its visible matter.
std::vector<glm::dvec3> framed_points(const ViewRequest& request) {
    const Volume& volume = *request.volume;
    std::vector<glm::dvec3> points;
    if (request.fill && request.scene) {
        const Volume* analysed = &volume;
        Volume level;
        if (volume.packed) {
            level = load_level(volume, finest_level_within(*volume.packed, kMaxVoxelsAnalysed));
            analysed = &level;
        }
        points = seen_points(*analysed, *request.scene);
        for (glm::dvec3& point : points)
            point = analysed->geometry.to_world(point);
    }
    if (request.fill && request.scene)
        for (std::size_t i = 0; i < request.scene->added.size(); ++i) {
            const Volume& added = *request.scene->added[i].volume;
            for (const glm::dvec3& point : seen_points(added, scene_of_volume(*request.scene, i + 1)))
                points.push_back(added.geometry.to_world(point));
        }
    for (int corner = 0; points.size() < 8 && corner < 8; ++corner) {
        const glm::dvec3 side(corner & 1, (corner >> 1) & 1, (corner >> 2) & 1);
        points.push_back(volume.geometry.to_world(side * glm::dvec3(volume.geometry.dims) - 0.5));
    }
    return points;
}

/// The first intersection of a ray with matter.
struct Meeting {
    double distance = 0;   ///< mm
    glm::dvec3 normal{0};  ///< unit normal of the surface towards the eye; world
};

/// The distances (mm) at which a ray enters the volume and leaves it; empty if it misses.
glm::dvec2 ends_in_volume(const glm::dvec3& from, const glm::dvec3& along, const glm::ivec3& dims) {
    glm::dvec2 ends(0, std::numeric_limits<double>::infinity());
    for (int axis = 0; axis < 3; ++axis) {
        const double low = -0.5 - from[axis], high = dims[axis] - 0.5 - from[axis];
        if (along[axis] == 0) {
            if (low > 0 || high < 0) return {0, -1};
            continue;
        }
        const auto [near, far] = std::minmax({low / along[axis], high / along[axis]});
        ends = {std::max(ends.x, near), std::min(ends.y, far)};
    }
    return ends;
}

/// Examines the samples nearest to places half a voxel apart.
std::optional<Meeting> first_surface(const glm::dvec3& eye, const glm::dvec3& direction, const ViewRequest& request) {
    const Volume& volume = *request.volume;
    const VolumeGeometry& geometry = volume.geometry;
    const double step = 0.5 * shortest_spacing(geometry);
    const IndexClip clip = index_clip(request.scene->effects.clip, geometry);
    const glm::ivec3 last = geometry.dims - 1;
    const glm::dmat3 to_index = glm::inverse(geometry.index_to_world_axes), to_normal = glm::transpose(to_index);
    const glm::dvec3 from = geometry.to_index(eye), along = to_index * direction;
    const glm::dvec2 ends = ends_in_volume(from, along, geometry.dims);
    const auto first = static_cast<std::int64_t>(std::ceil(ends.x / step));
    for (std::int64_t i = first; static_cast<double>(i) * step <= ends.y; ++i) {
        const double t = static_cast<double>(i) * step;
        const glm::dvec3 place = from + t * along;
        const glm::ivec3 index = glm::clamp(glm::ivec3(place + 0.5), glm::ivec3(0), last);
        const bool at_border = i > 0 && i == first;
        if ((!clip.empty() && clip.cuts_away(place)) || !volume.has_data(index) ||
            !shows(*request.scene, static_cast<double>(value_at(volume, index))))
            continue;
        glm::dvec3 gradient(0);
        for (int axis = 0; axis < 3; ++axis) {
            glm::ivec3 up = index, down = index;
            up[axis] = std::min(index[axis] + 1, last[axis]);
            down[axis] = std::max(index[axis] - 1, 0);
            const double rises = static_cast<double>(value_at(volume, up) - value_at(volume, down));
            // Matter cut by the volume's border has a flat face there.
            gradient[axis] = !at_border ? rises : up[axis] - down[axis] < 2 ? 1 : 0;
        }
        glm::dvec3 normal = to_normal * gradient;
        const double length = glm::length(normal);
        normal = length > 0 ? normal / length : -direction;
        return Meeting{t, glm::dot(normal, direction) > 0 ? -normal : normal};
    }
    return std::nullopt;
}

/// The target of `close`: the surface hit head-on by the central ray, else by the ray nearest to it. nullopt if no ray
/// hits a surface.
std::optional<glm::dvec3> point_to_look_at(const Camera& camera, const ViewRequest& request) {
    constexpr double kHeadOn = 0.5;  // cosine
    constexpr int kRings = 12, kAround = 16;
    const CameraFrame frame = camera_frame(camera);
    std::optional<glm::dvec3> grazed;
    for (int ring = 0; ring <= kRings; ++ring)
        for (int k = 0; k < (ring == 0 ? 1 : kAround); ++k) {
            const double angle = 2 * glm::pi<double>() * k / kAround;
            const double radius = 0.9 * frame.tan_half_y * ring / kRings;
            const glm::dvec3 direction =
                glm::normalize(frame.forward + radius * (std::cos(angle) * frame.right + std::sin(angle) * frame.up));
            const auto met = first_surface(camera.eye, direction, request);
            if (!met) continue;
            const glm::dvec3 point = camera.eye + met->distance * direction;
            if (-glm::dot(met->normal, direction) >= kHeadOn) return point;
            if (!grazed) grazed = point;
        }
    return grazed;
}

/// How much a picture shows of the shape: the number of directions that surfaces face (exponential of their entropy),
/// times their area perpendicular to the rays, in mm^2. A wall scores little even if it is near; a slab from its narrow
/// side has little area, and so has a row of objects seen from its end.
double shape_score(const Camera& camera, const ViewRequest& request) {
    constexpr int kRays = 40, kBins = 6;  // rays per side of the picture; bins of directions
    const CameraFrame frame = camera_frame(camera);
    const double aspect = static_cast<double>(request.width) / request.height;
    std::array<double, kBins * kBins> faced{};
    const auto place = [](int i, int count) { return 2 * (i + 0.5) / count - 1; };
    const auto bin = [](double cosine) { return std::clamp(static_cast<int>((cosine + 1) / 2 * kBins), 0, kBins - 1); };
    std::array<std::optional<Meeting>, kRays * kRays> meetings;
    parallel_for(kRays * kRays, [&](int begin, int end) {
        for (int i = begin; i < end; ++i) {
            const glm::dvec3 direction =
                glm::normalize(frame.forward + place(i % kRays, kRays) * frame.tan_half_y * aspect * frame.right +
                               place(i / kRays, kRays) * frame.tan_half_y * frame.up);
            meetings.at(static_cast<std::size_t>(i)) = first_surface(camera.eye, direction, request);
        }
    });
    double met = 0;
    for (const std::optional<Meeting>& found : meetings) {
        if (!found) continue;
        const int column = bin(glm::dot(found->normal, frame.right)), row = bin(glm::dot(found->normal, frame.up));
        // the distance between rays is proportional to their length
        const double area = found->distance * found->distance;
        faced.at(static_cast<std::size_t>(row * kBins + column)) += area;
        met += area;
    }
    double entropy = 0;
    for (const double area : faced)
        if (area > 0) entropy -= area / met * std::log(area / met);
    return std::exp(entropy) * met;
}

Camera camera_around(const std::vector<glm::dvec3>& points, const glm::dvec3& direction, const glm::dvec3& up,
                     const ViewRequest& request) {
    const glm::dvec3 center = request.volume->geometry.center();
    Camera camera{center, direction, up, request.fov_y};
    const CameraFrame frame = camera_frame(camera);
    const double tan_y = frame.tan_half_y / kMargin;
    const double tan_x = tan_y * request.width / request.height;
    const double infinity = std::numeric_limits<double>::infinity();
    // Positions of the picture's sides in the plane of the centre, so that every point is between them.
    glm::dvec4 most(-infinity);  // right, left, top, bottom
    for (const glm::dvec3& point : points) {
        const glm::dvec3 p = point - center;
        const double x = glm::dot(p, frame.right), y = glm::dot(p, frame.up), z = glm::dot(p, frame.forward);
        most = glm::max(most, glm::dvec4(x - z * tan_x, -x - z * tan_x, y - z * tan_y, -y - z * tan_y));
    }
    const double right = most.x, left = most.y, top = most.z, bottom = most.w;
    if (request.fill) {
        const double back = std::max((right + left) / tan_x, (top + bottom) / tan_y) / 2;
        camera.eye = center + (right - left) / 2 * frame.right + (top - bottom) / 2 * frame.up - back * frame.forward;
    } else {
        camera.eye = center - std::max(std::max(right, left) / tan_x, std::max(top, bottom) / tan_y) * frame.forward;
    }
    return camera;
}

}  // namespace

std::span<const std::string_view> view_names() {
    return kNames;
}

char patient_letter(const glm::dvec3& way) {
    const glm::dvec3 size = glm::abs(way);
    const std::size_t axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    return (way[static_cast<int>(axis)] > 0 ? "LPH" : "RAF")[axis];
}

glm::dmat3 volume_axes(const VolumeGeometry& geometry) {
    const glm::dmat3& axes = geometry.index_to_world_axes;
    return {glm::normalize(axes[0]), glm::normalize(axes[1]), glm::normalize(axes[2])};
}

Camera framing_camera(const glm::dvec3& direction, const glm::dvec3& up, const ViewRequest& request) {
    return camera_around(framed_points(request), direction, up, request);
}

std::string_view most_informative_view(const ViewRequest& request) {
    if (request.volume->packed) return "front";
    const std::vector<glm::dvec3> points = framed_points(request);
    const auto worth = [&](const NamedDirection& view) {
        return shape_score(camera_around(points, view.direction, view.up, request), request);
    };
    const NamedDirection* best = kViews.data();
    double most = kClearlyBetter * worth(*best);
    for (const NamedDirection& view : kViews) {
        const double score = &view == kViews.data() || view.direction[0] * view.direction[1] != 0 ? 0 : worth(view);
        if (score > most) {
            most = score;
            best = &view;
        }
    }
    return best->name;
}

Camera named_view(std::string_view name, const ViewRequest& request) {
    const auto view =
        std::find_if(kViews.begin(), kViews.end(), [&](const NamedDirection& v) { return v.name == name; });
    if (view == kViews.end()) fail("unknown view '{}', expected one of: {}", name, fmt::join(kNames, ", "));
    Camera camera = framing_camera(view->direction, view->up, request);
    if (name != "close") return camera;

    const double voxel = shortest_spacing(request.volume->geometry);
    const double tan_y = std::tan(glm::radians(request.fov_y) / 2);
    const double near = voxel * request.height / (2 * tan_y * kClosePixelsPerVoxel);
    const glm::dvec3 point = point_to_look_at(camera, request).value_or(request.volume->geometry.center());
    camera.eye = point - near * glm::normalize(camera.direction);
    return camera;
}

}  // namespace edgesplat

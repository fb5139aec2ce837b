#include "engine/scene/views.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "engine/error.h"
#include "engine/volume/packed_volume.h"

namespace edgesplat {
namespace {

constexpr double kMargin = 1.04;             ///< room around the bounding box
constexpr double kClosePixelsPerVoxel = 24;  ///< of the `close` view

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

/// Distance along the central ray of the camera at which a material that is not transparent begins.
std::optional<double> first_surface(const Camera& camera, const ViewRequest& request) {
    const Volume& volume = *request.volume;
    const VolumeGeometry& geometry = volume.geometry;
    const glm::dvec3 spacing = geometry.spacing();
    const double step = 0.5 * std::min({spacing.x, spacing.y, spacing.z});
    const glm::dvec3 forward = glm::normalize(camera.direction);
    const double end = 2 * glm::length(geometry.center() - camera.eye);
    const auto count = static_cast<std::int64_t>(end / step);
    for (std::int64_t i = 0; i <= count; ++i) {
        const double t = static_cast<double>(i) * step;
        const glm::ivec3 index(glm::round(geometry.to_index(camera.eye + t * forward)));
        if (glm::any(glm::lessThan(index, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(index, geometry.dims)))
            continue;
        const auto& isos = request.scene->iso_values;
        const double value = value_at(volume, index);
        const auto material =
            static_cast<std::size_t>(std::upper_bound(isos.begin(), isos.end(), value) - isos.begin());
        if (material < request.scene->materials.size() && request.scene->materials[material].extinction > 0) return t;
    }
    return std::nullopt;
}

}  // namespace

std::span<const std::string_view> view_names() {
    return kNames;
}

glm::dmat3 volume_axes(const VolumeGeometry& geometry) {
    const glm::dmat3& axes = geometry.index_to_world_axes;
    return {glm::normalize(axes[0]), glm::normalize(axes[1]), glm::normalize(axes[2])};
}

Camera framing_camera(const glm::dvec3& direction, const glm::dvec3& up, const ViewRequest& request) {
    const VolumeGeometry& geometry = request.volume->geometry;
    const glm::dvec3 center = geometry.center();
    Camera camera{center, direction, up, request.fov_y};
    const CameraFrame frame = camera_frame(camera);
    const double tan_y = frame.tan_half_y / kMargin;
    const double tan_x = tan_y * request.width / request.height;
    double back = 0;  // how far behind the centre the eye must be for every corner of the box to be seen
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 side(corner & 1, (corner >> 1) & 1, (corner >> 2) & 1);
        const glm::dvec3 p = geometry.to_world(side * glm::dvec3(geometry.dims) - 0.5) - center;
        const double spread =
            std::max(std::abs(glm::dot(p, frame.right)) / tan_x, std::abs(glm::dot(p, frame.up)) / tan_y);
        back = std::max(back, spread - glm::dot(p, frame.forward));
    }
    camera.eye = center - back * frame.forward;
    return camera;
}

Camera named_view(std::string_view name, const ViewRequest& request) {
    const auto view =
        std::find_if(kViews.begin(), kViews.end(), [&](const NamedDirection& v) { return v.name == name; });
    if (view == kViews.end()) fail("no view is called '{}'; there are {}", name, fmt::join(kNames, ", "));
    Camera camera = framing_camera(view->direction, view->up, request);
    if (name != "close") return camera;

    const glm::dvec3 spacing = request.volume->geometry.spacing();
    const double voxel = std::min({spacing.x, spacing.y, spacing.z});
    const double tan_y = std::tan(glm::radians(request.fov_y) / 2);
    const double near = voxel * request.height / (2 * tan_y * kClosePixelsPerVoxel);
    const double surface =
        first_surface(camera, request).value_or(glm::length(request.volume->geometry.center() - camera.eye));
    camera.eye += (surface - near) * glm::normalize(camera.direction);
    return camera;
}

}  // namespace edgesplat

// What in the picture can be taken hold of: clip planes and the sides of boxes, each moved along its normal.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "engine/scene/scene_document.h"
#include "engine/viewer/screen.h"

namespace edgesplat::viewer {

struct Handle {
    enum class Kind { Plane, KeepBox, RemoveBox };
    Kind kind = Kind::Plane;
    std::size_t index = 0;  ///< among effects.clip.keep; of a box: 2 * axis, and 1 more for its high side
    glm::dvec3 place{0};    ///< world mm, on the plane: nearest to the volume's centre, or the middle of the side
    glm::dvec3 normal{0};   ///< unit, world: to what is cut away; of a box that is cut out, out of it
};

/// Those of effects.clip.keep, keep_box and remove_box.
std::vector<Handle> clip_handles(const SceneDocument& document, const VolumeGeometry& geometry);

/// Where a handle is seen: at its place, or where that lies beyond the picture at its rim, `inset` pixels within. None
/// behind the eye. Throws like `project`.
std::optional<glm::dvec2> seen_at(const Handle& handle, const Camera& camera, const glm::ivec2& size, double inset);

/// The handle that is seen nearest to a pixel, at most `radius` pixels away. Throws like `project`.
std::optional<std::size_t> handle_at(std::span<const Handle> handles, const Camera& camera, const glm::ivec2& size,
                                     const glm::dvec2& pixel, double radius, double inset);

/// How far along a line (from `origin`, `direction` unit) the point lies that is nearest to a ray, mm; may be below 0.
/// None where the ray is nearly parallel to it (sine below 1e-3), or nearest to it at or behind its own origin.
std::optional<double> along_line(const Ray& ray, const glm::dvec3& origin, const glm::dvec3& direction);

/// Puts what a handle belongs to so many mm along its normal from where the handle says that it is. Planes stay where
/// they touch the volume, and sides of a box within the volume's box (or where they were beyond it) and half a voxel
/// before their opposite. Does nothing for a distance that is not finite.
void move_handle(SceneDocument& document, const VolumeGeometry& geometry, const Handle& handle, double millimetres);

/// Around all voxels, half of one beyond the outermost centres.
ClipBox volume_box(const VolumeGeometry& geometry);

/// Directions on a disc of radius 1, as seen by an eye: (0, 0, 1), towards the eye, is its middle, what is sideways
/// lies half the way out, straight away is the rim (azimuthal equidistant projection). +x is right, +y up in both.
glm::dvec2 disc_of(const glm::dvec3& direction);
/// Unit; places outside the disc count as on its rim.
glm::dvec3 direction_of(const glm::dvec2& disc);

}  // namespace edgesplat::viewer

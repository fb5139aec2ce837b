// Handles in the picture that the user drags: clip planes and box sides, each moved along its normal.
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
    std::size_t index = 0;  ///< into effects.clip.keep; for a box: 2 * axis, + 1 for its high side
    glm::dvec3 place{0};    ///< world mm, on the plane: nearest to the volume's centre, or the middle of the box side
    glm::dvec3 normal{0};   ///< unit, world. Plane, KeepBox: towards the removed matter; RemoveBox: out of the box
};

/// The handles of effects.clip.keep, keep_box and remove_box.
std::vector<Handle> clip_handles(const SceneDocument& document, const VolumeGeometry& geometry);

/// The pixel at which a handle appears: its projected place, clamped to `inset` pixels inside the picture's border.
/// nullopt behind the eye. Throws like `project`.
std::optional<glm::dvec2> handle_pixel(const Handle& handle, const Camera& camera, const glm::ivec2& size,
                                       double inset);

/// The handle that appears nearest to a pixel, at most `radius` pixels away. Throws like `project`.
std::optional<std::size_t> handle_at(std::span<const Handle> handles, const Camera& camera, const glm::ivec2& size,
                                     const glm::dvec2& pixel, double radius, double inset);

/// The t (mm, may be negative) of the point origin + t * direction (unit) that is nearest to a ray. nullopt if ray and
/// line are nearly parallel (sine below 1e-3), or if the ray's nearest point is at or behind its origin.
std::optional<double> along_line(const Ray& ray, const glm::dvec3& origin, const glm::dvec3& direction);

/// Moves a handle's plane or box side along its normal, `millimetres` from the place stored in the handle. Planes keep
/// touching the volume. Box sides stay within the volume's box (or where they already were beyond it), and half a voxel
/// before the opposite side. Does nothing if the distance is not finite.
void move_handle(SceneDocument& document, const VolumeGeometry& geometry, const Handle& handle, double millimetres);

/// World-aligned bounding box of all voxels, half a voxel beyond the outermost centres.
ClipBox volume_box(const VolumeGeometry& geometry);

/// Maps directions in the eye's frame to a disc of radius 1 (azimuthal equidistant projection). (0, 0, 1), towards the
/// eye, is the centre. Sideways directions have radius 1/2; straight away from the eye is the rim. +x is right and +y
/// is up in both.
glm::dvec2 disc_of(const glm::dvec3& direction);
/// Inverse of disc_of, unit. Points outside the disc count as points on its rim.
glm::dvec3 direction_of(const glm::dvec2& disc);

}  // namespace edgesplat::viewer

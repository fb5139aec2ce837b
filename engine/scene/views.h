// Named cameras, and cameras that frame a volume.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <string_view>

#include "engine/scene/camera.h"
#include "engine/scene/scene.h"
#include "engine/volume/volume.h"

namespace edgesplat {

/// What a view shows, and the picture's size.
struct ViewRequest {
    const Volume* volume = nullptr;
    const Scene* scene = nullptr;   ///< for `close`: defines the first surface
    double fov_y = 45;              ///< full vertical angle, degrees, (0, 180)
    int width = 512, height = 512;  ///< pixels
    /// true: frames and centres the visible part of the volume; false: frames the volume's bounding box.
    bool fill = false;
};

/// front, back, left, right, top, bottom, oblique, close. World axes: front looks along +y (LPS: at the face), left
/// along -x (from the patient's left), top along -z. Up is +z; for top and bottom it is -y (anterior is up in the
/// picture).
std::span<const std::string_view> view_names();

/// The camera with this name; it frames what `request` selects with a small margin. `close` is front moved near a
/// surface: the surface hit head-on by the central ray, else by the ray nearest to the centre. A voxel of it covers 24
/// pixels, at the centre of the picture. Throws Error listing the names.
Camera named_view(std::string_view name, const ViewRequest& request);

/// The view along a world axis that shows most of the shape: large surfaces with many orientations. front, unless
/// another view is clearly better (e.g. from the other side of a container, along a slab's axis). Deterministic.
std::string_view most_informative_view(const ViewRequest& request);

/// A camera that looks along `direction` (world, any length > 0) and frames what `request` selects.
Camera framing_camera(const glm::dvec3& direction, const glm::dvec3& up, const ViewRequest& request);

/// The patient direction closest to `way` (world, LPS): L(eft), R(ight), P(osterior), A(nterior), H(ead), F(oot).
char patient_letter(const glm::dvec3& way);

/// Direction cosines: the unit vectors of the volume's i, j, k axes in world space.
glm::dmat3 volume_axes(const VolumeGeometry& geometry);

}  // namespace edgesplat

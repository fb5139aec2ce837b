// Cameras that need no numbers: a name, and the volume to look at.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <string_view>

#include "engine/scene/camera.h"
#include "engine/scene/scene.h"
#include "engine/volume/volume.h"

namespace edgesplat {

/// What a named view is to show, and on how many pixels.
struct ViewRequest {
    const Volume* volume = nullptr;
    const Scene* scene = nullptr;   ///< tells `close` where the first surface is
    double fov_y = 45;              ///< full vertical angle, degrees, (0, 180)
    int width = 512, height = 512;  ///< pixels
    /// Frame what the scene shows of the volume, in the middle of the picture; else all of the volume's box.
    bool fill = false;
};

/// front, back, left, right, top, bottom, oblique, close. World axes: front looks along +y (LPS: at the face), left
/// along -x (from the patient's left), top along -z; up is +z, for top and bottom -y (anterior is up in the picture).
std::span<const std::string_view> view_names();

/// The camera of that name; all that `request` frames is in the picture with a small margin. `close` is front moved
/// near a surface: that on the central ray where it is met head on, else the nearest to the middle of the picture that
/// is; a voxel of it covers 24 pixels, in the middle. Throws Error listing the names.
Camera named_view(std::string_view name, const ViewRequest& request);

/// Of the views along the world's axes the one that tells most of what is seen: surfaces that face many ways and are
/// large. front, unless another tells clearly more (from the other side of a container, along a slab's axis). The
/// same volume and scene have always the same.
std::string_view telling_view(const ViewRequest& request);

/// A camera that looks along `direction` (world, any length > 0) at all that `request` frames.
Camera framing_camera(const glm::dvec3& direction, const glm::dvec3& up, const ViewRequest& request);

/// What is nearest to a direction of a patient (world, LPS): L(eft), R(ight), P(osterior), A(nterior), H(ead), F(oot).
char patient_letter(const glm::dvec3& way);

/// Direction cosines: the world axes of the volume's i, j, k, each of unit length.
glm::dmat3 volume_axes(const VolumeGeometry& geometry);

}  // namespace edgesplat

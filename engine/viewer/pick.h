// What the ray through a pixel meets, and how well its place is known.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "engine/scene/camera.h"
#include "engine/scene/scene.h"
#include "engine/viewer/samples.h"
#include "engine/viewer/screen.h"
#include "engine/volume/volume.h"

namespace edgesplat::viewer {

/// The visible surface on a ray.
struct Pick {
    glm::dvec3 world{0};     ///< mm
    glm::dvec3 voxel{0};     ///< the same place in index space
    double value = 0;        ///< interpolated there
    double distance = 0;     ///< mm from the eye
    double uncertainty = 0;  ///< mm along the ray, either way
    int material = 0;        ///< of the matter behind the surface: number of iso-values <= its value
    glm::dvec3 normal{0};    ///< unit, world, towards the eye
};

/// Where the opacity accumulated along the ray first reaches `opacity`, in (0, 1); none where it never does. Values are
/// trilinear, extinction is per mm by material or transfer function, clip planes cut.
///
/// Where that happens in solid matter (half of the light is lost in one voxel, as in Walls) the place is the surface
/// by which the ray came into it: an iso-contour, whose crossing is computed to 1e-9 of a voxel, a clip plane, or the
/// side of the volume. Of an iso-contour the uncertainty is twice the disagreement with the cubic B-spline through
/// the samples, and the larger of half a step of the values' quantisation and what an edge sharper than samples can
/// show leaves open; a clip plane has none; the side of the volume, half a voxel. In other matter the place is where
/// the opacity is reached, and the uncertainty the distance between the opacities halfway to it and halfway beyond it
/// (0.25 and 0.75). Throws Error: opacity out of range, an invalid scene, a camera without a frame.
std::optional<Pick> pick(const Volume& volume, const Scene& scene, const Camera& camera, const glm::ivec2& size,
                         const glm::dvec2& pixel, double opacity = 0.5);

/// The same along any ray.
std::optional<Pick> pick(const Volume& volume, const Scene& scene, const Ray& ray, double opacity = 0.5);

}  // namespace edgesplat::viewer

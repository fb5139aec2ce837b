// Finds the visible surface at a pixel, and the uncertainty of its place.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <vector>

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
    double value = 0;        ///< interpolated at that place
    double distance = 0;     ///< mm from the eye
    double uncertainty = 0;  ///< mm along the ray, in either direction
    std::size_t number = 0;  ///< of the volume (scene_of_volume), whose voxel, value and material these are
    int material = 0;        ///< of the matter behind the surface: number of iso-values <= its value
    glm::dvec3 normal{0};    ///< unit, world, towards the eye
};

/// A volume's value at a place.
struct ValueThere {
    std::size_t number = 0;  ///< of the volume
    glm::dvec3 voxel{0};
    double value = 0;  ///< trilinear
};

/// The values of all of the scene's volumes whose grids hold the place (world mm).
std::vector<ValueThere> values_at(const Volume& volume, const Scene& scene, const glm::dvec3& place);

/// A volume of the scene by its number; the first one if there is none.
const Volume& volume_of(const Volume& first, const Scene& scene, std::size_t number);

/// The place on the ray where the accumulated opacity of one of the scene's volumes, the nearest, first reaches
/// `opacity`, in (0, 1); nullopt if it never does. Values are trilinear. Extinction (per mm) comes from material or
/// transfer function. Clip planes cut.
///
/// In solid matter (one voxel absorbs half of the light, as in Walls) the place is the surface through which the ray
/// entered that matter. The uncertainty depends on the surface. Iso-contour (computed to 1e-9 voxel): twice the
/// disagreement with the cubic B-spline through the samples, plus the larger of half a quantisation step and the effect
/// of an edge sharper than the samples resolve. Clip plane: 0. Side of the volume: half a voxel.
///
/// In other matter the place is where the opacity is reached. The uncertainty is the distance between the opacities
/// halfway to it and halfway from it to 1 (0.25 and 0.75). Throws Error: opacity out of range, an invalid scene, a
/// camera without a frame.
std::optional<Pick> pick(const Volume& volume, const Scene& scene, const Camera& camera, const glm::ivec2& size,
                         const glm::dvec2& pixel, double opacity = 0.5);

/// The same for any ray.
std::optional<Pick> pick(const Volume& volume, const Scene& scene, const Ray& ray, double opacity = 0.5);

}  // namespace edgesplat::viewer

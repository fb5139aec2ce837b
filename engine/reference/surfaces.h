// Surface splats: faces that agree with the field, and the pictures that their votes decide (docs/method/surfaces.md).
// Lengths are voxels, index space.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "engine/reference/5_draw_splats.h"
#include "engine/scene/transfer_function.h"

namespace edgesplat::reference {

/// The bodies of matter that surface splats show (scene_of_bodies), in scaled units.
struct SurfaceScene {
    SurfaceScene(const Scene& whole, const Volume& volume);
    Scene scene;            ///< one material for each body
    ScaledScene bodies;     ///< of `scene`
    ScaledScene materials;  ///< of the whole scene
};

/// The face of a surface splat at voxel i of body m, which ends beside it. `noise`: standard deviation of the
/// samples' noise, scaled. `traced` is set if the field must be searched instead,
/// wherever the face's error, in D2, shows.
VoxelEdge fit_surface(const Field& field, const ScaledScene& bodies, const std::vector<VoxelEdge>& surfels,
                      const glm::ivec3& i, int m, double noise);

/// The splats of the voxels that matter ends beside, ascending by voxel. Their materials are those of the whole scene.
/// `surfels` are edges of the bodies.
std::vector<SplatRecord> surface_splats(const Field& field, const SurfaceScene& surfaces,
                                        const std::vector<VoxelEdge>& surfels, double noise, bool quantised);

/// A surface that a ray meets.
struct SeenSurface {
    glm::dvec4 value{0};                                   ///< payload times opacity, opacity
    double way = std::numeric_limits<double>::infinity();  ///< from the eye along the ray, voxels
    bool solid = false;                                    ///< nothing is seen behind it
};

/// A picture of surface splats with one ray per pixel, row by row.
struct SurfacePicture {
    std::vector<std::array<SeenSurface, 2>> pixels;  ///< the nearer surface first
    std::vector<std::optional<Outline>> outlines;    ///< empty unless outlines are smoothed
};
SurfacePicture draw_surfaces(std::span<const SplatRecord> records, const Field& field, const SurfaceScene& surfaces,
                             const Scene& scene, const View& view, const Settings& settings, Payload payload);

/// Premultiplied payload and opacity of its pixels, before outlines are smoothed.
std::vector<glm::dvec4> composited(const SurfacePicture& picture);

}  // namespace edgesplat::reference

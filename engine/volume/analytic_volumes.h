// Volumes whose value, gradient and edges are known exactly: for tests, and for pictures without a file. Positions are
// in index space: the centre of voxel (0,0,0) is the origin, one unit is one voxel.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/volume/volume.h"

namespace edgesplat {

/// Maps the signed distance of a solid to values: `inside`, `outside` and a blurred step between them.
struct EdgeProfile {
    double inside = 1;
    double outside = 0;
    double blur = 0.7;    ///< standard deviation of the Gaussian that blurs the step, voxels, > 0
    bool binary = false;  ///< sharp step: `inside` where the signed distance is <= 0; the gradient is then 0 everywhere
    double iso_value() const { return 0.5 * (inside + outside); }
};

/// An analytic scene. Its functions may be called from several threads at once.
struct AnalyticScene {
    std::string name;
    glm::ivec3 dims{64};                                    ///< voxels of the default grid
    glm::dvec3 spacing{1};                                  ///< mm per voxel, axis-aligned
    std::vector<double> iso_values;                         ///< iso-values of its edges, ascending; never empty
    std::function<double(const glm::dvec3&)> value;         ///< f(x)
    std::function<glm::dvec3(const glm::dvec3&)> gradient;  ///< df/dx per voxel; 0 in binary scenes
    /// Distance to the nearest edge of iso_values[0], voxels, negative inside (value >= iso). Empty for scenes without
    /// a closed form (marschner-lobb, orbital, phantom). Exact except for gyroid: there it is 0 on the surface, has
    /// unit slope there, and is wrong by a few per cent one voxel away.
    std::function<double(const glm::dvec3&)> signed_distance;
    /// Whether there are no data at x; empty: there are data everywhere.
    std::function<bool(const glm::dvec3&)> without_data;
    double rise = 1;               ///< reference for relative noise: inside - outside, else the value range
    double noise = 0;              ///< standard deviation of the noise that `sample` adds, in the unit of the value
    std::uint32_t noise_seed = 1;  ///< the same seed gives the same samples on every machine
};

/// Names of the builtin scenes (described in docs/method.md, Builtin scenes).
std::span<const std::string_view> analytic_scene_names();

/// The scene with that name and its default grid. Throws Error listing the names.
AnalyticScene analytic_scene(std::string_view name);

/// The same scene stretched to another grid, each axis by its own factor; value and gradient are transformed. The
/// signed distance is removed unless all three factors are equal. Throws Error unless all dims >= 2.
AnalyticScene resized(const AnalyticScene& scene, const glm::ivec3& dims);

/// Half space: inside where (x - point) . normal <= 0. `normal` has any length > 0.
AnalyticScene plane_scene(const glm::ivec3& dims, const glm::dvec3& normal, const glm::dvec3& point,
                          const EdgeProfile& profile = {});
/// Ball. The blur is applied along the radius, so the edge (value = iso) stays exactly at the radius.
AnalyticScene sphere_scene(const glm::ivec3& dims, const glm::dvec3& center, double radius,
                           const EdgeProfile& profile = {});
/// Torus around the z axis through `center`.
AnalyticScene torus_scene(const glm::ivec3& dims, const glm::dvec3& center, double major_radius, double minor_radius,
                          const EdgeProfile& profile = {});
/// Slab of a thickness (voxels) centred at `point`: the exact Gaussian blur of a slab, a difference of two erfs. A slab
/// thinner than about 1.35 blur never reaches the iso-value; signed_distance is that of the unblurred slab.
AnalyticScene slab_scene(const glm::ivec3& dims, const glm::dvec3& normal, const glm::dvec3& point, double thickness,
                         const EdgeProfile& profile = {});
/// Cube of `side` voxels with a cylindrical hole of `hole_radius` along z (side 12 in the paper), centred in the grid.
AnalyticScene cube_hole_scene(const glm::ivec3& dims, double side, double hole_radius, const EdgeProfile& profile);

/// The sample at a voxel centre of the scene's grid, including noise.
float sample_at(const AnalyticScene& scene, const glm::ivec3& voxel);

/// Samples the scene at the voxel centres of its grid, adds its noise and finishes the volume.
Volume sample(const AnalyticScene& scene);

/// Whether the path has the form "builtin:NAME" (NAME may be unknown).
bool is_builtin(std::string_view path);

/// The scene of "builtin:NAME". Optional suffixes: ":64" or ":64x48x32" (another grid), ":noise=0.02" (standard
/// deviation as a share of `rise`, 0 to 10, replaces the scene's own) and ":seed=3" (noise_seed). Throws Error.
AnalyticScene builtin_scene(std::string_view path);

/// Samples the scene of such a path. Throws Error.
Volume builtin_volume(std::string_view path);

}  // namespace edgesplat

// The scaled field F and the ways it is sampled and differentiated (method.md, 1_estimate_edges).
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "engine/scene/scene.h"
#include "engine/volume/volume.h"

namespace edgesplat::reference {

/// Samples as the GPU holds them. Positions are in index space (voxels).
struct Field {
    glm::ivec3 dims{0};                   ///< voxels per axis, each >= 1
    std::span<const float> values;        ///< F, scaled to 0..1, (dims.z, dims.y, dims.x)
    std::span<const float> coefficients;  ///< cubic B-spline coefficients, alike; empty unless `cubic` is asked for

    std::size_t offset(const glm::ivec3& i) const;
    glm::ivec3 voxel(std::size_t offset) const;
    glm::ivec3 clamped(const glm::ivec3& i) const { return glm::clamp(i, glm::ivec3(0), dims - 1); }
    double at(const glm::ivec3& i) const { return static_cast<double>(values[offset(clamped(i))]); }
};

/// What estimation needs of a scene, in the units of F.
struct ScaledScene {
    std::vector<double> iso;              ///< J_j, ascending; float32 precision, as the GPU compares them
    std::vector<bool> drawn;              ///< per material: extinction > 0 somewhere in its interval
    std::vector<bool> seen_through;       ///< per material: it does not hide what is behind it (materials_seen_through)
    std::vector<TransferPoint> transfer;  ///< values scaled alike; empty without a transfer function
    bool light = false;                   ///< splats want normals, for light or silhouettes
    int material(double f) const;         ///< number of iso-values <= f
    double lower(int m) const;            ///< J_{m-1}, -infinity below the first
    double upper(int m) const;            ///< J_m, +infinity above the last
};

/// The scene in F's units. Iso-values that all samples reach are -1e9, those above all of them +1e9.
ScaledScene scale_scene(const Scene& scene, const Volume& volume);

/// T(p), trilinear, p clamped to the volume; with `cubic` the cubic B-spline of the coefficients, which goes on
/// straight.
double sample(const Field& field, const glm::dvec3& p, bool cubic = false);

/// The gradient of the cubic B-spline of the coefficients.
glm::dvec3 spline_gradient(const Field& field, const glm::dvec3& p);

/// g(i): central differences, one-sided at a border, 0 along an axis of one voxel.
glm::dvec3 voxel_gradient(const Field& field, const glm::ivec3& i);

/// The field's own at voxel i: the spline's where there are coefficients, else g(i).
glm::dvec3 field_gradient(const Field& field, const glm::ivec3& i);

/// G(p): mean slope over the unit sphere around p, by the 14-point Lebedev rule; p is moved to at least one
/// voxel inside the border.
glm::dvec3 point_gradient(const Field& field, const glm::dvec3& p, bool cubic = false);

}  // namespace edgesplat::reference

// The scaled field F, its interpolation and its gradients (docs/method/1_estimate_edges.md).
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "engine/scene/scene.h"
#include "engine/volume/volume.h"

namespace edgesplat::reference {

/// The samples as on the GPU. Positions are in index space (voxels).
struct Field {
    glm::ivec3 dims{0};                   ///< voxels per axis, each >= 1
    std::span<const float> values;        ///< F, (dims.z, dims.y, dims.x): scaled to 0..1, kScaledNoData without data
    std::span<const float> coefficients;  ///< cubic B-spline coefficients, same shape; empty unless `cubic` is used

    std::size_t offset(const glm::ivec3& i) const;
    glm::ivec3 voxel(std::size_t offset) const;
    glm::ivec3 clamped(const glm::ivec3& i) const { return glm::clamp(i, glm::ivec3(0), dims - 1); }
    double at(const glm::ivec3& i) const { return static_cast<double>(values[offset(clamped(i))]); }
    /// Of a scaled field.
    bool has_data(std::size_t offset) const { return values[offset] >= 0; }
};

/// The part of a scene that estimation reads, in units of F.
struct ScaledScene {
    std::vector<double> iso;              ///< J_j, ascending; float32 precision, as the GPU compares them
    std::vector<bool> drawn;              ///< per material: extinction > 0 somewhere in its interval
    std::vector<bool> is_translucent;     ///< per material (translucent_materials)
    std::vector<TransferPoint> transfer;  ///< with scaled values; empty without a transfer function
    const ShownLabels* labels = nullptr;  ///< Volume::shown_labels; null without labels in own colours
    bool two_values = false;              ///< Volume::two_values
    bool light = false;                   ///< splats need normals, for light or silhouettes
    int material(double f) const;         ///< number of iso-values <= f
    double lower(int m) const;            ///< J_{m-1}, -infinity below the first
    double upper(int m) const;            ///< J_m, +infinity above the last
};

/// The scene in units of F. An iso-value that all samples reach becomes -1e9, one above all samples +1e9.
ScaledScene scale_scene(const Scene& scene, const Volume& volume);

/// T(p): trilinear, p clamped to the volume. With `cubic`: the cubic B-spline, continued linearly beyond the outermost
/// samples.
double sample(const Field& field, const glm::dvec3& p, bool cubic = false);

/// The gradient of the cubic B-spline of the coefficients.
glm::dvec3 spline_gradient(const Field& field, const glm::dvec3& p);

/// g(i): central differences, one-sided at a border, 0 along an axis of one voxel.
glm::dvec3 voxel_gradient(const Field& field, const glm::ivec3& i);

/// Gradient at voxel i: of the spline if there are coefficients, else g(i).
glm::dvec3 field_gradient(const Field& field, const glm::ivec3& i);

/// G(p): mean slope over the unit sphere around p, by the 14-point Lebedev rule. p is first moved to at least one voxel
/// inside the border.
glm::dvec3 point_gradient(const Field& field, const glm::dvec3& p, bool cubic = false);

}  // namespace edgesplat::reference

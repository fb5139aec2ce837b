// Piecewise-linear transfer functions, and properties of a scene that follow from its extinctions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "engine/scene/scene.h"
#include "engine/scene/settings.h"
#include "engine/volume/volume.h"
#include "footprints/kernel.h"

namespace edgesplat {

/// The transfer function at `value`, exactly; `points` ascending, at least one.
TransferPoint transfer_at(std::span<const TransferPoint> points, double value);

/// Extinctions, per mm.
struct ExtinctionRange {
    double least = 0, most = 0;
};

/// Range of extinction in a material's interval of values: from the material or the transfer function.
ExtinctionRange extinctions_of(const Scene& scene, std::size_t material);

/// Whether all visible matter is opaque: at least 4 per voxel, so that at most 2 % of light passes a voxel.
bool all_matter_is_opaque(const Scene& scene, const VolumeGeometry& geometry);

/// Bit m: material m contains translucent matter.
std::uint32_t translucent_materials(const Scene& scene, const VolumeGeometry& geometry);

/// Bit m: voxels next to material m emit splats of it, too. Only with faces, for translucent materials.
std::uint32_t materials_carried_beside(const Settings& settings, const Scene& scene, const VolumeGeometry& geometry);

/// Whether kernels are cut only at faces (no clip planes) and all matter is opaque. Kernels are then the narrow ones.
bool draws_opaque_faces(const Settings& settings, const Scene& scene, const VolumeGeometry& geometry);

/// The kernel of voxels without a face.
const Kernel& uncut_kernel(const Settings& settings, const Scene& scene, const VolumeGeometry& geometry);

/// Maximum sampling depth below faces in the footprint table, voxels: `FACE_DEPTH` with narrow kernels, or 0 for no
/// limit.
double table_depth(const Scene& scene, const VolumeGeometry& geometry);

/// Whether the longer of two pieces of a ray within a kernel is sufficient: for whole, unclipped, opaque kernels.
bool has_single_piece(const Settings& settings, const Scene& scene, const VolumeGeometry& geometry);

/// Whether surface splats draw the scene: all matter is opaque and no sample without data lies in its values, with
/// settings and effects that allow it.
bool draws_surfaces(const Settings& settings, const Scene& scene, const Volume& volume);

/// The same scene, without a transfer function, with one material for each body: a run of materials with matter, or of
/// materials without. Only where bodies meet, opaque matter has a surface that is seen.
Scene scene_of_bodies(const Scene& scene);

/// Voxels of a scene's opaque matter along a ray behind which surface splats show nothing.
double solid_chord(const Scene& scene, const VolumeGeometry& geometry);

/// Whether matter would be drawn where samples contain no data, if they counted as the smallest value: with a transfer
/// function, because values between them and others are drawn, too.
bool draws_missing_samples(const Scene& scene, const Volume& volume);

/// The scene's transfer points with values scaled like samples (scaled_field), rounded to float32 as on the device.
/// Empty without a transfer function. For a constant volume: one point, the function at its value.
std::vector<TransferPoint> scaled_transfer(const Scene& scene, const Volume& volume);

}  // namespace edgesplat

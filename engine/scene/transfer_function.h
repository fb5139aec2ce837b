// Colour and extinction by value: piecewise-linear transfer functions, and what materials are where there is none.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "engine/scene/scene.h"
#include "engine/scene/settings.h"
#include "engine/volume/volume.h"
#include "footprints/kernel.h"

namespace edgesplat {

/// The function at `value`, exactly; `points` ascending, at least one.
TransferPoint transfer_at(std::span<const TransferPoint> points, double value);

/// Per mm.
struct ExtinctionRange {
    double least = 0, most = 0;
};

/// Extinctions that occur in a material's interval of values: its own, or what the transfer function has there.
ExtinctionRange extinctions_of(const Scene& scene, std::size_t material);

/// Whether all matter that is seen lets at most 2 % of light through a voxel.
bool hides_what_is_behind(const Scene& scene, const VolumeGeometry& geometry);

/// Bit m: material m has matter that does not hide what is behind it.
std::uint32_t materials_seen_through(const Scene& scene, const VolumeGeometry& geometry);

/// Those that voxels beside them carry, too: where faces cut kernels.
std::uint32_t materials_carried_beside(const Settings& settings, const Scene& scene, const VolumeGeometry& geometry);

/// Whether faces, and they alone, cut kernels of which all hide what is behind them: kernels are the narrow ones then.
bool draws_opaque_faces(const Settings& settings, const Scene& scene, const VolumeGeometry& geometry);

/// The kernel of voxels that nothing cuts.
const Kernel& uncut_kernel(const Settings& settings, const Scene& scene, const VolumeGeometry& geometry);

/// No deeper under the faces of a table of footprints kernels are sampled, voxels: `kFaceDepth`, and then kernels are
/// narrow, or 0.
double table_depth(const Scene& scene, const VolumeGeometry& geometry);

/// Whether of two pieces of a ray in one kernel the longer is enough: in whole kernels, uncut, that hide what is
/// behind.
bool one_piece_is_enough(const Settings& settings, const Scene& scene, const VolumeGeometry& geometry);

/// The one material whose faces rays may find where no quadric fits: all that is drawn, whole and opaque, of a field
/// that is a cubic spline.
std::optional<std::size_t> traced_material(const Settings& settings, const Scene& scene,
                                           const VolumeGeometry& geometry);

/// The scene's points with values scaled as samples are (scaled_field), rounded to float32 as the device holds them;
/// empty without a transfer function. In a constant volume one point: the function at its value.
std::vector<TransferPoint> scaled_transfer(const Scene& scene, const Volume& volume);

}  // namespace edgesplat

// Transfer functions as a hand changes them.
#pragma once

#include <optional>
#include <vector>

#include "engine/scene/scene_document.h"
#include "engine/scene/scene_presets.h"

namespace edgesplat::viewer {

/// Points are ascending and stay so. `gap` > 0: nearest that the values of two may come, in the volume's unit.
using TransferPoints = std::vector<TransferPoint>;

/// Adds a point on the function, which stays what it is. Returns its place; none where there are kMaxTransferPoints or
/// none at all, where one lies nearer than `gap`, and for a value that is not finite.
std::optional<std::size_t> add_transfer_point(TransferPoints& points, double value, double gap);

/// Moves a point, at most to `gap` before its neighbours; extinctions below 0 become 0. What is not finite stays as it
/// was.
void move_transfer_point(TransferPoints& points, std::size_t place, double value, double extinction, double gap);

/// The last one stays. Whether it is gone.
bool remove_transfer_point(TransferPoints& points, std::size_t place);

/// The materials of a scene as a function: steps `width` > 0 wide or narrower that end at the iso-values, and a point
/// at `low` and `high` where these lie beyond, so that what is added changes the function only up to its neighbours.
/// What is transparent has the colour of what lies next to it, since colours are interpolated.
TransferPoints transfer_of_materials(const Scene& scene, double low, double high, double width);

/// Points in place of the materials' colours and extinctions; iso-values and their materials stay as edges.
void use_transfer(SceneDocument& document, TransferPoints points);

/// The points of a preset that is a transfer function, and its iso-values as edges. Throws Error as resolve_scene does:
/// an iso-value that does not occur in the volume.
void use_transfer_preset(SceneDocument& document, const Volume& volume, const ScenePreset& preset);

/// Materials again. Where there are no iso-values they are chosen as for a new scene. Throws Error as resolve_scene.
void use_materials(SceneDocument& document, const Volume& volume);

/// A scale on which extinctions are edited: logarithmic, but for what is nearly transparent.
struct ExtinctionScale {
    double least = 1e-3, most = 1e3;  ///< per mm: below the one it is linear; the other is its upper end
    /// 1e-3 to 1e3 per voxel of mean spacing.
    static ExtinctionScale of(const VolumeGeometry& geometry);
    double share(double extinction) const;  ///< of the way from 0 to `most`: 0..1, clamped
    double extinction(double share) const;  ///< inverse; shares outside 0..1 are clamped
};

}  // namespace edgesplat::viewer

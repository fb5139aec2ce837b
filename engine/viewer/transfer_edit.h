// Interactive changes of transfer functions.
#pragma once

#include <optional>
#include <vector>

#include "engine/scene/scene_document.h"
#include "engine/scene/scene_presets.h"

namespace edgesplat::viewer {

/// Points are ascending and stay so. `gap` > 0 below: least distance between two values, in the volume's unit.
using TransferPoints = std::vector<TransferPoint>;

/// Adds a point on the function, which does not change it. Returns its index. nullopt if there are no points or
/// kMaxTransferPoints, if a point is nearer than `gap`, and for a value that is not finite.
std::optional<std::size_t> add_transfer_point(TransferPoints& points, double value, double gap);

/// Moves a point, at most to `gap` before its neighbours; extinctions below 0 become 0. A value or extinction that is
/// not finite is ignored.
void move_transfer_point(TransferPoints& points, std::size_t place, double value, double extinction, double gap);

/// Removes a point. Returns whether it did: the last one stays.
bool remove_transfer_point(TransferPoints& points, std::size_t place);

/// Converts a scene's materials to a function. Each iso-value becomes a step that ends at it, at most `width` > 0 wide.
/// `low` and `high` get points if they lie beyond the steps, so that an added point changes the function only up to its
/// neighbours. A transparent material has the colour of its neighbour, because colours are interpolated.
TransferPoints transfer_of_materials(const Scene& scene, double low, double high, double width);

/// Replaces the materials' colours and extinctions by points; iso-values and their materials stay as edges.
void use_transfer(SceneDocument& document, TransferPoints points);

/// Uses the points of a transfer function preset, and its iso-values as edges. Throws Error as resolve_scene does: an
/// iso-value that does not occur in the volume.
void use_transfer_preset(SceneDocument& document, const Volume& volume, const ScenePreset& preset);

/// Returns to materials. Missing iso-values are chosen as for a new scene. Throws Error as resolve_scene does.
void use_materials(SceneDocument& document, const Volume& volume);

/// The scale on which extinctions are edited: logarithmic, but linear near 0.
struct ExtinctionScale {
    double least = 1e-3, most = 1e3;  ///< per mm: linear below `least`; `most` is its upper end
    /// From 1e-3 to 1e3 per voxel of mean spacing.
    static ExtinctionScale of(const VolumeGeometry& geometry);
    double share(double extinction) const;  ///< position between 0 and `most`: 0..1, clamped
    double extinction(double share) const;  ///< inverse; shares outside 0..1 are clamped
};

}  // namespace edgesplat::viewer

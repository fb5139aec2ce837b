// A volume that others cut: a virtual resection. docs/method/clip.md, Cuts by volumes.
#pragma once

#include <memory>
#include <span>

#include "engine/volume/volume.h"

namespace edgesplat {

/// A solid that cuts: all places of a volume's grid where its field is at least `iso` (the samples' unit).
struct Cutter {
    std::shared_ptr<const Volume> volume;
    double iso = 0;
    bool operator==(const Cutter&) const = default;
};

/// The volume without its matter in the cutters' solids, wherever their grids lie. Matter is samples from `iso` on (the
/// samples' unit); where a cutter's surface crosses it, the field falls through `iso` at the surface. Samples more than
/// kCutReach voxels outside all solids stay as they are. Throws Error for packed volumes.
Volume without_solids(const Volume& volume, double iso, std::span<const Cutter> cutters);

/// Voxels beside a cut in which samples change.
inline constexpr double kCutReach = 2.5;

}  // namespace edgesplat

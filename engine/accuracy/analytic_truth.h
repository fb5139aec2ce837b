// Finds the exact scene of a builtin volume.
#pragma once

#include <optional>
#include <string_view>

#include "engine/scene/scene_document.h"
#include "engine/volume/analytic_volumes.h"

namespace edgesplat::accuracy {

/// The scene of "builtin:NAME" with its grid and noise, on the grid that `builtin_volume` samples; nullopt for other
/// paths.
std::optional<AnalyticScene> analytic_scene_of(std::string_view path);

/// The scene of such a volume; nullopt if the volume is filtered or cropped.
std::optional<AnalyticScene> analytic_scene_of(const VolumeSource& source);

}  // namespace edgesplat::accuracy

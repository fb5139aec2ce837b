// The exact scene behind a builtin volume.
#pragma once

#include <optional>
#include <string_view>

#include "engine/scene/scene_document.h"
#include "engine/volume/analytic_volumes.h"

namespace edgesplat::accuracy {

/// Of "builtin:NAME" with its grid and noise, on the grid that `builtin_volume` samples; nothing for other paths.
std::optional<AnalyticScene> analytic_scene_of(std::string_view path);

/// Of a volume read like that; nothing where it is filtered or cropped.
std::optional<AnalyticScene> analytic_scene_of(const VolumeSource& source);

}  // namespace edgesplat::accuracy

// The exact scene behind a builtin volume.
#pragma once

#include <optional>
#include <string_view>

#include "engine/volume/analytic_volumes.h"

namespace edgesplat::accuracy {

/// Of "builtin:NAME" with its grid and noise, on the grid that `builtin_volume` samples; nothing for other paths.
std::optional<AnalyticScene> analytic_scene_of(std::string_view path);

}  // namespace edgesplat::accuracy

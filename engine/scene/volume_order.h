// An order of the volumes of a scene that does not depend on how the scene lists them.
#pragma once

#include <vector>

#include "engine/scene/scene.h"
#include "engine/volume/volume.h"

namespace edgesplat {

/// Numbers by which volumes are ordered: of its samples, its place and its matter. `scene`: of the volume alone.
std::vector<double> volume_order(const Volume& volume, const Scene& scene);

}  // namespace edgesplat

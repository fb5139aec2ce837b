// Divides a scene into opaque matter, which surface splats draw, and translucent matter, which kernels draw in front of
// those surfaces.
#pragma once

#include <optional>

#include "engine/scene/scene.h"
#include "engine/scene/settings.h"
#include "engine/volume/volume.h"

namespace edgesplat {

struct Mixture {
    Scene surfaces;  ///< the scene without its translucent matter
    /// The scene's translucent matter. It continues into the opaque matter beside it, since rays end there: so kernels
    /// have no edge at that surface.
    Scene kernels;
};

/// nullopt unless the scene has both kinds of matter and surface splats can draw the opaque one.
std::optional<Mixture> mixture_of(const Settings& settings, const Scene& scene, const Volume& volume);

}  // namespace edgesplat

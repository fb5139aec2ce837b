// What a perfect renderer would show of an analytic scene: materials between the exact surfaces, without any samples,
// kernels or estimated edges (method.md, Reference).
#pragma once

#include "engine/reference/direct_evaluation.h"
#include "engine/volume/analytic_volumes.h"

namespace edgesplat::reference {

/// The material at x is the number of iso-values <= scene.value(x), inside the box [-0.5, dims - 0.5] and nothing
/// outside; noise is not part of the scene. Light falls on the exact normal: of the distance to the nearest edge where
/// the scene has a closed form of it, else of the value at x. Premultiplied colour and alpha, 4 channels, over the
/// background, the mean of as many rays a pixel as `look` asks for. Throws Error for a geometry of other dims than the
/// scene's, an invalid `look`, camera, picture size or options, and Cancelled.
DirectResult truth(const AnalyticScene& scene, const VolumeGeometry& geometry, const Scene& look, const Camera& camera,
                   int width, int height, const DirectOptions& options = {});

}  // namespace edgesplat::reference

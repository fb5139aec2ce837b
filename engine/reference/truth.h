// The exact picture of an analytic scene: materials between the exact surfaces, without samples, kernels or estimated
// edges (docs/method/reference.md).
#pragma once

#include "engine/reference/direct_evaluation.h"
#include "engine/volume/analytic_volumes.h"

namespace edgesplat::reference {

/// The material at x is the number of iso-values <= scene.value(x) inside the box [-0.5, dims - 0.5]; outside there is
/// nothing. Noise is not part of the scene. Light falls on the exact normal: the gradient of the signed distance if the
/// scene has one, else of the value. Result: premultiplied colour and alpha, 4 channels, over the background, the mean
/// of as many rays a pixel as `look` requests. Throws Error if the dims of geometry and scene differ, or `look`,
/// camera, picture size or options are invalid; Cancelled if progress cancels.
DirectResult truth(const AnalyticScene& scene, const VolumeGeometry& geometry, const Scene& look, const Camera& camera,
                   int width, int height, const DirectOptions& options = {});

}  // namespace edgesplat::reference

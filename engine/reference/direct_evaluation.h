// Evaluates the converged model: integrates the sum of all kernels along rays to a tolerance, without splats, sheets or
// tables (docs/method/reference.md). All approximations are measured against it.
#pragma once

#include <cstdint>

#include "engine/reference/pixel_rows.h"
#include "engine/reference/reference_renderer.h"

namespace edgesplat::reference {

struct DirectOptions {
    /// Upper bound of the error per pixel and channel, relative to full scale (1); relative to tau where tau > 1. (0,
    /// 0.1]
    double tolerance = 1e-4;
    Progress progress;  ///< called repeatedly from the calling thread; returning false throws Cancelled
};

struct DirectResult {
    Image image;
    double error_estimate = 0;  ///< largest over all pixels; relative to tau where tau > 1
    std::uint64_t samples = 0;  ///< points at which the model was evaluated
};

/// The mean of n x n pictures, each with one ray a pixel at another offset, drawn by `draw`. Progress covers all of
/// them.
DirectResult mean_of_samples(View view, int n, const DirectOptions& options,
                             const std::function<DirectResult(const View&, const DirectOptions&)>& draw);

/// Throws Error unless the tolerance is in range.
void check_options(const DirectOptions& options);

/// Integrates the sum of all kernels, sum_i sigma_i h_i(x), along the ray of every pixel, in front of the eye only.
/// Output: Color (4 channels) or Tau (1). Throws Error for other outputs, pictures without pixels, scenes of several
/// volumes and invalid options. Colour is the mean over the scene's number of rays a pixel. No voxel is buried or
/// culled, whatever the camera.
DirectResult direct_evaluation(const PreparedVolume& prepared, const Camera& camera, int width, int height,
                               Output output = Output::Color, const DirectOptions& options = {});

}  // namespace edgesplat::reference

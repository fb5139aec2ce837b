// The model itself: rays through the sum of all kernels, without splats, sheets or tables, to a tolerance (method.md,
// Reference). Every approximation is measured against this.
#pragma once

#include <cstdint>

#include "engine/reference/pixel_rows.h"
#include "engine/reference/reference_renderer.h"

namespace edgesplat::reference {

struct DirectOptions {
    /// Largest error aimed at, per pixel and channel, of full scale (1); of tau where tau is above 1. (0, 0.1]
    double tolerance = 1e-4;
    Progress progress;  ///< called now and then from the calling thread; returning false throws Cancelled
};

struct DirectResult {
    Image image;
    double error_estimate = 0;  ///< largest over pixels; of tau where that is above 1
    std::uint64_t samples = 0;  ///< points at which the model was evaluated
};

/// The mean of the pictures of n x n rays a pixel, each of `draw` for a view whose rays are moved; progress is of all.
DirectResult mean_of_samples(View view, int n, const DirectOptions& options,
                             const std::function<DirectResult(const View&, const DirectOptions&)>& draw);

/// Throws Error unless the tolerance is in range.
void check_options(const DirectOptions& options);

/// sum_i tau_i h_i(x) along the ray of every pixel, from the eye on (what a kernel has behind the eye does not count).
/// Color (4 channels) or Tau (1); other outputs throw Error, as do a picture without pixels and invalid options.
/// Colour is the mean of as many rays a pixel as the scene asks for. Depends on no other camera's pictures: nothing is
/// buried, nothing culled.
DirectResult direct_evaluation(const PreparedVolume& prepared, const Camera& camera, int width, int height,
                               Output output = Output::Color, const DirectOptions& options = {});

}  // namespace edgesplat::reference

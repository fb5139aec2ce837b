// Figures 4, 6, 7, 8 and the misprints: the sections that need no device.
#pragma once

#include <filesystem>

#include "apps/paper/document.h"
#include "apps/plots/paper_curves.h"

namespace edgesplat {

/// Sharpness and place of the edge in a reconstruction of the two-tone data; lengths in voxels.
struct StepQuality {
    double rise = 0;      ///< from 10 to 90 % of the step
    double location = 0;  ///< place where it crosses one half, minus the edge's place
    double rms = 0;       ///< against the ideal step, x in [-1.5, 2.5]
};
/// `value` falls from `example.left` to `example.right`.
StepQuality step_quality(const CurveExample& example, const std::function<double(double)>& value);

/// Draws Figures 4, 6, 7 and 8 into `images` and describes them.
std::vector<Section> curve_sections(const CurveExample& example, const std::filesystem::path& images);

/// The misprints with their proofs.
Section misprint_section(const PaperProfile& profile);

}  // namespace edgesplat

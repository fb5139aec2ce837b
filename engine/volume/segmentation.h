// A scan with a segmentation of the same object: the scan supplies the surfaces, the segmentation the colours and the
// choice of what is shown. docs/method/shading.md, Labels of a scan.
#pragma once

#include <vector>

#include "engine/volume/volume.h"

namespace edgesplat {

/// Gives the scan the labels of a segmentation, which may have any other grid: each voxel that at its centre, in world
/// space; none for the background. Sets `labels` and `shown_labels`; the samples stay. Notes and warnings say what a
/// different grid does. Throws Error if the second volume is no segmentation, or has no label inside the scan.
void add_segmentation(Volume& scan, const Volume& segmentation);

/// The scan with only the matter of the labels that are `shown`, per place in the table, and with matter of no label if
/// `unlabelled`. Beside a label, matter of no label up to a voxel away belongs to it, so that its surface is the scan's
/// own one there; elsewhere matter ends at the smoothed surface of what is shown. `iso`: the lowest value of matter, in
/// the samples' unit.
Volume with_labels_shown(const Volume& scan, const std::vector<bool>& shown, bool unlabelled, double iso);

}  // namespace edgesplat

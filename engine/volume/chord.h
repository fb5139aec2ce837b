// How long a ray is in matter.
#pragma once

#include "engine/volume/volume.h"

namespace edgesplat {

/// Mean length of the pieces of straight lines in the matter of a volume in memory, mm: lines along the grid's three
/// axes, as many in each direction per area. Matter is samples with data from `iso` on (the samples' unit). A ball of
/// radius r has 4 r / 3, as in all directions (Cauchy). 0 without matter.
double mean_chord(const Volume& volume, double iso);

}  // namespace edgesplat

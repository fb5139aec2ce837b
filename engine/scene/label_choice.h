// Chooses labels of a segmentation by number and name.
#pragma once

#include <string>
#include <vector>

#include "engine/volume/volume.h"

namespace edgesplat {

/// Per place in the table: whether the label is shown. Labels that `only` names, or, if it is empty, all but the
/// background (background_label), if there is one; without those that `hide` names. An entry is a number, a name
/// without regard to case, a name with * for any letters, or several of these between commas. Throws Error if an entry
/// names no label of the volume, with the closest names, or if none is left.
std::vector<bool> chosen_labels(const Volume& volume, const LabelTable& table, const std::vector<std::string>& only,
                                const std::vector<std::string>& hide);

/// "7 spleen", or "7" for a label without a name.
std::string text_of(const LabelTable& table, const Label& label);

}  // namespace edgesplat

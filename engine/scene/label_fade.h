// Labels that are drawn translucent.
#pragma once

#include <string>

#include "engine/scene/scene_document.h"

namespace edgesplat {

/// Draws labels of the document's volume with an opacity (VolumeSource::opacity), in (0, 1]: they are hidden in it, and
/// an entry of `volumes` shows them alone. `labels` as in VolumeSource::only; "*" is the whole volume. Of several calls
/// the last counts. An opacity of 1 shows them as the others are.
void fade_labels(SceneDocument& document, const std::string& labels, double opacity);

/// The opacity that fade_labels has given to exactly these labels; 1 if none.
double opacity_of_labels(const SceneDocument& document, const std::string& labels);

}  // namespace edgesplat

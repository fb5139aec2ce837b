// What resolve_scene gives materials that are left open, and that written out.
#pragma once

#include <glm/glm.hpp>

#include "engine/scene/scene_document.h"

namespace edgesplat {

/// Linear light. By a material's place from the lowest iso-value up, the first is 0; after the sixth they begin anew.
glm::dvec3 default_color(std::size_t place);

/// Linear light, of a thing by its number in a segmentation, from 1.
glm::dvec3 default_label_color(std::size_t label);

/// Per mm. `highest`: no iso-value lies above the material's.
double default_extinction(bool highest, const VolumeGeometry& geometry);

/// Everything of a material said.
MaterialChoice choice_of(const Material& material);

/// Writes out iso-values and materials as they are in a scene of the document.
void write_out_materials(SceneDocument& document, const Scene& scene);

}  // namespace edgesplat

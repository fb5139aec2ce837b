// Default colours and extinctions of materials, and the materials of a scene as document entries.
#pragma once

#include <glm/glm.hpp>

#include "engine/scene/scene_document.h"

namespace edgesplat {

/// Default colour (linear light) of the material with index `place`, from 0 at the lowest iso-value; repeats after the
/// sixth.
glm::dvec3 default_color(std::size_t place);

/// Default colour (linear light) of a label by its number, from 1.
glm::dvec3 default_label_color(std::size_t label);

/// The colour of each label of the table: its own, else a default one by its number, or by its place if some number is
/// above 256.
std::vector<glm::dvec3> label_colors(const LabelTable& table);

/// Default extinction per mm. `highest`: the material above the highest iso-value.
double default_extinction(bool highest, const VolumeGeometry& geometry);

/// The complete description of a material.
MaterialChoice choice_of(const Material& material);

/// Copies iso-values and materials of the scene into the document; of drawn labels only the material that they share,
/// with the colour that the document chooses, if any.
void write_out_materials(SceneDocument& document, const Scene& scene, const Volume& volume);

}  // namespace edgesplat
